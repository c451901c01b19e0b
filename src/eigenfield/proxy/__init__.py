"""Reading the proxy mesh and giving it an atlas (the paper's section 3.1)."""

from eigenfield.proxy.atlas import AtlasStatistics, atlas_fault, atlas_statistics, chart_labels
from eigenfield.proxy.prepare import check_seen, prepare_proxy
from eigenfield.proxy.read import read_mesh
from eigenfield.proxy.unwrap import DEFAULT_TRIANGLES, simplified, unwrapped
from eigenfield.proxy.write import write_ply

__all__ = [
    "DEFAULT_TRIANGLES",
    "AtlasStatistics",
    "atlas_fault",
    "atlas_statistics",
    "chart_labels",
    "check_seen",
    "prepare_proxy",
    "read_mesh",
    "simplified",
    "unwrapped",
    "write_ply",
]
