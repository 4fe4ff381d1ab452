"""Stages of light propagation volumes: the core's own functions take what a user holds."""

from __future__ import annotations

from interreflect import _core

inject, geometry_volume, propagate, look_up = _core.inject, _core.geometry_volume, _core.propagate, _core.look_up
