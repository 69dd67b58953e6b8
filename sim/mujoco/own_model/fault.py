"""What keeps a model of the user's own from being held to a closed form."""

from __future__ import annotations

from models.errors import EngineError


class ModelError(EngineError):
    """A model that can not be read, or that is no planar mechanism with one driver."""
