"""The proxy mesh (the paper's section 3.1): read, or made from depth; its atlas."""

from eigenfield.proxy.atlas.layout import AtlasStatistics, atlas_fault, atlas_statistics, chart_labels
from eigenfield.proxy.atlas.unwrap import DEFAULT_TRIANGLES, simplified, unwrapped, welded
from eigenfield.proxy.background import fill_background
from eigenfield.proxy.meshes.prepare import check_seen, prepare_proxy
from eigenfield.proxy.meshes.read import read_mesh
from eigenfield.proxy.meshes.write import check_mesh_name, write_mesh, write_ply
from eigenfield.proxy.primitives.shapes import Primitive, insert_primitive, parse_primitive
from eigenfield.proxy.primitives.sphere_fit import find_view, fit_sphere, parse_region
from eigenfield.proxy.relief.layers import second_layer
from eigenfield.proxy.relief.make import relief_mesh
from eigenfield.proxy.surface.multiview import Surface, surface_from_views

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
