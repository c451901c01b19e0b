"""The proxy mesh (section 3.1 of the paper): read from a file or reconstructed from depth, with an atlas.

What arguments are throughout, unless a function says otherwise: `vertices` (n, 3), `faces` (m, 3), `uv` (n, 2) with v
down, `points` and `positions` (n, 3) in the world; over a depth map `d` (h, w) labels and `valid` (h, w) where there is
surface.
"""

from eigenfield.proxy.atlas.layout import AtlasStatistics, atlas_fault, atlas_statistics, chart_labels
from eigenfield.proxy.atlas.unwrap import unwrap_mesh
from eigenfield.proxy.meshes.read import read_mesh, refuse_no_mesh
from eigenfield.proxy.meshes.write import check_mesh_name, write_mesh, write_ply
from eigenfield.proxy.prepare import prepare_proxy
from eigenfield.proxy.primitives.shapes import Primitive, insert_primitive, parse_primitive
from eigenfield.proxy.primitives.sphere_fit import find_view, fit_sphere, parse_region
from eigenfield.proxy.relief.layers import estimate_second_layer
from eigenfield.proxy.relief.make import relief_mesh
from eigenfield.proxy.relief.soft import soft_relief
from eigenfield.proxy.simplify import PROXY_DEFAULT_TRIANGLES, simplify_mesh, weld_vertices
from eigenfield.proxy.surface.multiview import surface_from_views

__all__ = [
    "PROXY_DEFAULT_TRIANGLES",
    "AtlasStatistics",
    "Primitive",
    "atlas_fault",
    "atlas_statistics",
    "chart_labels",
    "check_mesh_name",
    "estimate_second_layer",
    "find_view",
    "fit_sphere",
    "insert_primitive",
    "parse_primitive",
    "parse_region",
    "prepare_proxy",
    "read_mesh",
    "refuse_no_mesh",
    "relief_mesh",
    "simplify_mesh",
    "soft_relief",
    "surface_from_views",
    "unwrap_mesh",
    "weld_vertices",
    "write_mesh",
    "write_ply",
]
