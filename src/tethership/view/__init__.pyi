from .campaign.plot import plot_campaign as plot_campaign
from .flight.docking import plot_docking as plot_docking
from .flight.loads import plot_loads as plot_loads
from .linear.interactive_locus import interactive_root_locus as interactive_root_locus
from .linear.mode_shape import plot_modes as plot_modes
from .linear.root_locus import plot_root_locus as plot_root_locus
from .picture import png as png
from .replay import write_replay as write_replay
