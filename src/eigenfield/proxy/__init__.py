"""The proxy mesh (the paper's section 3.1): read, or made from depth; its atlas."""

from eigenfield.proxy.atlas import AtlasStatistics, atlas_fault, atlas_statistics, chart_labels
from eigenfield.proxy.background import fill_background
from eigenfield.proxy.layers import second_layer
from eigenfield.proxy.multiview import Surface, surface_from_views
from eigenfield.proxy.prepare import check_seen, prepare_proxy
from eigenfield.proxy.primitives import Primitive, insert_primitive, parse_primitive
from eigenfield.proxy.read import read_mesh
from eigenfield.proxy.relief import relief_mesh
from eigenfield.proxy.sphere_fit import find_view, fit_sphere, parse_region
from eigenfield.proxy.unwrap import DEFAULT_TRIANGLES, simplified, unwrapped, welded
from eigenfield.proxy.write import check_mesh_name, write_mesh, write_ply

__all__ = [
    "DEFAULT_TRIANGLES",
    "AtlasStatistics",
    "Primitive",
    "Surface",
    "atlas_fault",
    "atlas_statistics",
    "chart_labels",
    "check_mesh_name",
    "check_seen",
    "fill_background",
    "find_view",
    "fit_sphere",
    "insert_primitive",
    "parse_primitive",
    "parse_region",
    "prepare_proxy",
    "read_mesh",
    "relief_mesh",
    "second_layer",
    "simplified",
    "surface_from_views",
    "unwrapped",
    "welded",
    "write_mesh",
    "write_ply",
]
