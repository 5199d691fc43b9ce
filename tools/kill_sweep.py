"""Kill a sweep again and again at random moments, go on each time, and compare the outcome with a sweep left alone.

    python tools/kill_sweep.py [--points 10000] [--kills 5] [--workers 1] [--batch 40] [--seed 1]
    python tools/kill_sweep.py --changes 50 [--seed 1]

``--batch 0``: as many points as take a few seconds.

Partial contact with adhesion at given penetrations: about 3 ms a point. Each run is ended by SIGKILL, parent only: its
workers have to notice. Exit status 1 unless the final CSV and netCDF files are the same bytes, no finished batch was
solved again, and no file that is not whole was ever left in place.

``--changes``: so many times the scene is changed and the sweep begun anew with ``--restart``, killed at a random moment, and
run again: the numbers must be those of the changed scene, never a row of the one before.
"""

import argparse
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

FILES = ("killed.sweep.csv", "killed.sweep.nc")
SCENE = """
penetration = {{ start = 1e-8, stop = 6e-8, num = 10 }}
velocity = {{ start = 1e-4, stop = 1e-2, num = {velocities}, spacing = "log" }}
rtol = 1e-2
[sweep]
{batch}
[material]
K = 1e9
T_eps = 0.01
T_sigma = 1e-4
[adhesion]
gamma = {gamma}
delta_0 = 1e-8
[[levels]]
l = 5e-7
h = 1e-7
"""


def scene(velocities: int, batch: int | None, gamma: str) -> str:
    """Text of a scene of partial contact, ten penetrations by so many velocities by the energies of adhesion."""
    return SCENE.format(velocities=velocities, batch=f"batch = {batch}" if batch else "", gamma=gamma)


class Run:
    """A folder with the scene, and sweeps of it as processes of their own."""

    def __init__(self, folder: Path, points: int, batch: int, workers: int):
        folder.mkdir(parents=True)
        (folder / "killed.toml").write_text(scene(points // 20, batch, "[1e-5, 2e-5]"), encoding="utf-8")
        self.folder, self.workers, self.out = folder, workers, folder / "hystrip-out"

    def start(self) -> subprocess.Popen:
        command = [sys.executable, "-m", "hystrip", "sweep", "killed.toml", "--netcdf", "--workers", str(self.workers)]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        return subprocess.Popen(command, cwd=self.folder, start_new_session=True, **pipes)

    def finish(self) -> str:
        """Run to the end; standard output. RuntimeError if that fails."""
        process = self.start()
        out, err = process.communicate()
        if process.returncode:
            raise RuntimeError(err)
        return out

    def batches(self) -> dict[str, int]:
        """Finished batches and when they were written."""
        return {path.name: path.stat().st_mtime_ns for path in self.out.glob("killed.parts/part-*.json")}


def wait_for(run: Run, batches: int, process: subprocess.Popen) -> None:
    """Until so many batches are finished."""
    while len(run.batches()) < batches and process.poll() is None:
        time.sleep(0.002)


def compare(folder: Path, points: int, kills: int, workers: int, batch: int, seed: int, say=print) -> list[str]:
    """What went wrong, one line each: nothing, if the sweep is what it promises."""
    # what is left alone has one worker: their number changes no byte
    alone, killed = Run(folder / "alone", points, batch, 1), Run(folder / "killed", points, batch, workers)
    start = time.monotonic()
    alone.finish()
    took = time.monotonic() - start
    total = len(alone.batches())
    say(f"left alone: {took:.1f} s, {total} batches")
    wrong, chance, before = [], random.Random(seed), {}
    for number in range(1, kills + 1):
        process = killed.start()
        # after a random number of batches that leaves some for the runs to come, and then somewhere in the next ones
        wait_for(killed, len(before) + chance.randint(0, (total - len(before)) // (kills + 2 - number)), process)
        time.sleep(chance.uniform(0, 2 * took / total))
        process.kill()
        process.communicate()
        if process.returncode != -signal.SIGKILL:
            wrong.append(f"run {number} ended by itself, with status {process.returncode}: more points are needed")
        after = killed.batches()
        wrong += [f"run {number} solved {name} again" for name, stamp in before.items() if after.get(name) != stamp]
        wrong += [f"run {number} left {name}" for name in FILES if (killed.out / name).exists()]
        say(f"kill {number}: {len(before)} -> {len(after)} batches")
        before = after
    said = killed.finish().splitlines()[0]
    after = killed.batches()
    wrong += [f"the last run solved {name} again" for name, stamp in before.items() if after.get(name) != stamp]
    say(f"last run: {said}")
    for name in FILES:
        same = (killed.out / name).read_bytes() == (alone.out / name).read_bytes()
        say(f"{name}: {'the same bytes' if same else 'DIFFERS'}, {(killed.out / name).stat().st_size} of them")
        wrong += [] if same else [f"{name} differs"]
    return wrong


CHANGING = """
pressure = 5e6
velocity = {{ start = 1e-4, stop = 1e-2, num = 300, spacing = "log" }}
[sweep]
batch = 1
[material]
K = 1e9
T_eps = {T_eps}
T_sigma = 1e-4
[[levels]]
l = 1e-5
h = 1e-6
"""


def change(folder: Path, changes: int, seed: int, say=print) -> list[str]:
    """What went wrong when the scene changed and the new sweep was killed as it deleted the old one's parts, or later."""
    import hystrip

    def changed(number: int, where: Path) -> Path:
        (where / "changing.toml").write_text(CHANGING.format(T_eps=0.01 + 0.001 * (number % 2)), encoding="utf-8")
        return where / "changing.toml"

    def run(*options: str) -> subprocess.Popen:
        command = [sys.executable, "-m", "hystrip", "sweep", "changing.toml", *options]
        return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    expected = []
    for number in range(2):
        alone = folder / f"alone{number}"
        alone.mkdir(parents=True)
        expected.append(hystrip.sweep(changed(number, alone), out=alone / "out").path.read_bytes())
    chance, wrong, kept, refused = random.Random(seed), [], 0, 0
    changed(0, folder)
    start = time.monotonic()
    run().communicate()
    took = time.monotonic() - start
    parts = folder / "hystrip-out/changing.parts"
    plan = parts / "plan.json"
    for number in range(1, changes + 1):
        changed(number, folder)
        before = len(list(parts.glob("part-*")))
        process, end = run("--restart"), time.monotonic() + 4 * took
        if number % 3:  # while it deletes; at other times anywhere in the run
            goal = chance.randint(0, before)
            while len(list(parts.glob("part-*"))) > goal and process.poll() is None and time.monotonic() < end:
                pass
        else:
            time.sleep(chance.uniform(0, 1.2 * took))
        process.kill()
        process.communicate()
        left, held = len(list(parts.glob("part-*"))), plan.exists()
        again = run()
        said, why = again.communicate()
        if again.returncode == 2 and "--restart" in why:
            refused += 1
            again = run("--restart")
            said, why = again.communicate()
        kept += "from before" in said
        if again.returncode or (folder / "hystrip-out/changing.sweep.csv").read_bytes() != expected[number % 2]:
            wrong.append(f"change {number}: rows of the other scene, or no result: {said}{why}")
        at = f"killed with {left} of {before} parts there" + ("" if held else ", without a plan")
        say(f"change {number}: {at}: {said.splitlines()[:1]}")
    say(f"{changes} changes: {refused} refused as another scene's, {kept} went on, {len(wrong)} wrong")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in (("points", 10_000), ("kills", 5), ("workers", 1), ("batch", 40), ("seed", 1), ("changes", 0)):
        parser.add_argument(f"--{name}", type=int, default=default)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if given.changes:
            wrong = change(Path(folder), given.changes, given.seed)
        else:
            wrong = compare(Path(folder), given.points, given.kills, given.workers, given.batch, given.seed)
    print("\n".join(wrong) if wrong else "nothing lost, nothing repeated")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
