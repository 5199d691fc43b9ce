"""``python -m hystrip``: the command line."""

from hystrip.commands.entry import main

if __name__ == "__main__":
    main()
