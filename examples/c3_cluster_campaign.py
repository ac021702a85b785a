"""A campaign on a Dask cluster: here two processes of this machine, elsewhere the address of your own scheduler."""

from pathlib import Path

from matplotlib.figure import Figure

import tethership as ts


def main():
    from distributed import LocalCluster  # pip install 'tethership[cluster]'

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        found = ts.run_campaign(
            "gusts", "out/c3_cluster_campaign", {"samples": 48}, scheduler=cluster.scheduler_address
        )
    print(f"{found.flown} flights, {found.answers['failed']} failed")  # started again it goes on where it was
    drawn = Figure(layout="constrained")
    axes = drawn.subplots()
    wind = found.data["input"].sel(law="own", quantity="wind.speed")
    axes.semilogy(wind, found.data["tension_max"].sel(law="own"), ".")
    axes.set_xlabel("wind [m/s]")
    axes.set_ylabel("largest tension [N]")
    Path("out").mkdir(exist_ok=True)
    drawn.savefig("out/c3_cluster_campaign.png", dpi=120)


if __name__ == "__main__":  # the workers read this file too
    main()
