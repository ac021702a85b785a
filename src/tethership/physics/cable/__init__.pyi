from .elastic import ElasticCatenary as ElasticCatenary
from .law import AbstractTensionLaw as AbstractTensionLaw
from .law import CableForce as CableForce
from .load import CableLoad as CableLoad
from .published import PublishedTension as PublishedTension
