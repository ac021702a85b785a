"""Cables: the load on a cable, and two laws for its tension (`published`, `elastic_catenary`)."""

from tethership.physics.cable.elastic import ElasticCatenary
from tethership.physics.cable.law import AbstractTensionLaw, CableForce
from tethership.physics.cable.load import CableLoad
from tethership.physics.cable.published import PublishedTension

__all__ = ["AbstractTensionLaw", "CableForce", "CableLoad", "ElasticCatenary", "PublishedTension"]
