"""Reader of a user's own MJCF file."""

from sim.mujoco.own_model.read_model import read_model
from sim.registry.own_models import Reader

READER: Reader = read_model
