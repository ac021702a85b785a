"""Pictures as bytes, with the run they show. Depends on: matplotlib, results."""

import io

from matplotlib.figure import Figure

from tethership.results import RUN


def png(drawn: Figure, dpi: int, run: str | None = None) -> bytes:
    """Return a figure as the bytes of a PNG file; its text chunk `run` says which run it shows.

    Parameters
    ----------
    drawn : Figure
        Its size is in [inch].
    dpi : int
        Pixels per inch [px/inch].
    run : str, optional
        Id of the run.
    """
    content = io.BytesIO()
    drawn.savefig(content, format="png", dpi=dpi, metadata=None if run is None else {RUN: run})
    return content.getvalue()
