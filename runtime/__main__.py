"""``python -m hystrip``: the command line."""

from .commands.entry import main

if __name__ == "__main__":
    main()
