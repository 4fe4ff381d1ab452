"""Where does a method break? Failures, the atlas of break points, methods in motion, and what must not change a picture."""

from interreflect.stability.break_points import Atlas, atlas
from interreflect.stability.cache_failures import CACHES
from interreflect.stability.composition_failures import COMPOSITION
from interreflect.stability.failure import Failure, Reading
from interreflect.stability.invariants import Invariance, invariance
from interreflect.stability.moving_failures import MOVING
from interreflect.stability.still_failures import STILL
from interreflect.stability.temporal import Played, motion
from interreflect.stability.virtual_light_failures import VIRTUAL_LIGHTS
from interreflect.stability.voxel_failures import VOXELS

failures: tuple[Failure, ...] = (*VOXELS, *CACHES, *VIRTUAL_LIGHTS, *COMPOSITION, *STILL, *MOVING)

__all__ = ["Atlas", "Failure", "Invariance", "Played", "Reading", "atlas", "failures", "invariance", "motion"]
