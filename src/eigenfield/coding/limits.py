"""Limits of the format, checked before anything is allocated. `docs/format.md` states the same numbers."""

from __future__ import annotations

from eigenfield.core.rights import RIGHTS_MAX_CHARACTERS

EXTENSION = "EIGENFIELD_eigen_textures"
VERSION = "1.11"  # of the format without its codecs; a reader takes any 1.x

MAX_FILE = 2**32 - 1  # bytes: glTF's length is a uint32
MAX_JSON = 64 * 2**20  # bytes of the JSON chunk
MAX_DEPTH = 64  # of nested objects and arrays
MAX_CHUNKS = 64
MAX_VIEWS = 16_384  # buffer views, and accessors

MAX_SIDE = 16_384  # texels of an atlas along one axis
MAX_STACKED = 32_768  # rows of a picture whose channels are stacked
MAX_PRECISION_SIDE = 1_024  # of the picture of a mean's precision
MAX_TEXELS = 2**27  # of one picture, stacked channels counted
MAX_CHANNELS = 64
MAX_PLANES = 16
MAX_BASES = 64  # of one plane
MAX_COMPONENTS = 4_096  # eigen textures, of all planes together
MAX_DECODED = 8 * 2**30  # bytes of all means (float32) and textures (uint8, of 10 bits uint16)

MAX_CAMERAS = 100_000
MAX_CAMERA_SIDE = 65_535  # pixels
MAX_CAMERA_PIXELS = 2**29
MAX_NAME = 1_024  # characters of a camera's name
MAX_RIGHTS = RIGHTS_MAX_CHARACTERS  # of a title, an author, a licence, a source
MAX_NAMES = 2**25  # bytes of coded names, inflated
MAX_VERTICES = 2**26
MAX_TRIANGLES = 2**27
MAX_SHEETS = 32
MAX_WEIGHTS = 2**28

MAX_GAIN = 1_000  # of a camera's colours, and at least its reciprocal
MAX_OFFSET = 1_000

MAX_GROUPS = 65_536  # of a clip
MAX_FRAMES = 2**20  # of a clip
MAX_GROUP_FRAMES = 1_024
MAX_GROUP = 2**30  # bytes
MAX_GROUP_JSON = 2**22  # bytes of a group's head, inflated
MAX_AUDIO = 2**28  # bytes of the sound of a clip
MAX_RATE = 1_000  # frames a second, and at least its reciprocal
MAX_RATE_TERM = 2**31 - 1  # of the fraction that a rate is
MAX_TIME = 10**9  # seconds
MAX_FILMS = 4
MAX_FILM_SIDE = 8_192
MAX_FILM_PIXELS = 2**24
MAX_MOTION = 2**25  # vertices that move in a group, times its frames

MAX_VIDEO = 2**35  # pixels of all frames of a residual: they are decoded one by one

MAX_NUMBER = 1e30  # magnitude of lengths, calibrations, scales, weights: squares and products stay finite
ORTHONORMAL_TOLERANCE = 2e-4  # largest entry of |A Aᵀ - I| for a rotation, and for the view plane's axes
