r"""
A sweep on a Dask cluster
=========================

Any quantity of a scene may be a list or a range. All combinations are solved in batches that go to disk as they come: after
a kill the same call goes on where it was. The batches run in this process, in local ones, or on a cluster.
"""

import tempfile

import hystrip

folder = tempfile.mkdtemp()

# %%
# Here the cluster is one process of this machine; ``scheduler="tcp://host:8786"`` takes any other.

from hystrip.extras import require  # noqa: E402

LocalCluster = require("distributed", "dask", "a Dask cluster").LocalCluster
over = {"adhesion.gamma": [0.0, 1e-5, 2e-5], "levels[1].h": [50e-9, 100e-9]}
with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as cluster:
    sweep = hystrip.sweep("paper_fig7", over=over, out=folder, scheduler=cluster.scheduler_address)
print(sweep)

# %%
# Run again, nothing is left to solve:

again = hystrip.sweep("paper_fig7", over=over, out=folder)
print(f"{again.solved} batches solved, {again.kept} from before")

# %%
# The result has a dimension for each swept quantity:

data = sweep.to_dataset()
print(data.mu.dims, dict(data.mu.sizes))

# %%
# A picture of what the small level adds, by its height:

import matplotlib.pyplot as plt  # noqa: E402

figure, panel = plt.subplots(figsize=(4, 3), layout="constrained")
for h in data.h_2.values:
    line = data.mu.sel(gamma=0.0, h_2=h)
    panel.semilogx(line.velocity, 1e4 * line, label=f"$h_2$ = {h * 1e9:.0f} nm")
panel.set_xlabel("sliding velocity (m/s)")
panel.set_ylabel(r"friction coefficient ($10^{-4}$)")
legend = panel.legend(frameon=False)
