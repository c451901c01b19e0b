"""python write_scenes.py FOLDER: small scenes of every codec and shape, for the Khronos validator to judge."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))

from eigenfield.core.proxy import Proxy
from eigenfield.gltf import save
from eigenfield.viewer.exports import write_glb, write_splats
from support.clips import numbered_clip
from support.coded_scenes import coded_scene
from support.scenes import bumpy_square, tiny_scene
from support.soft_scenes import coded_soft_scene, soft_scene

SHAPES = [(3, 3), (1, 2), (6, 2), (3, 0)]  # channels, eigen textures


def main(folder: Path) -> None:
    """Write every combination, one mesh that needs long indices, scenes of which everything is coded or that have
    sheets, exports for other viewers, Gaussians, and a clip."""
    folder.mkdir(parents=True, exist_ok=True)
    for codec in ("png", "webp", "avif"):
        for channels, textures in SHAPES:
            scene = tiny_scene(channels, textures, cameras=6, held_out=(1,))
            save(scene, folder / f"{codec}-{channels}-{textures}.glb", codec=codec, overwrite=True)
    large = replace(tiny_scene(), proxy=Proxy(bumpy_square(256)))
    save(large, folder / "large.glb", codec="png", overwrite=True)
    save(tiny_scene(cameras=2), folder / "line.glb", overwrite=True)
    for fallback in ("small", "good", "none"):
        save(coded_scene(), folder / f"coded-{fallback}.glb", fallback=fallback, overwrite=True)
    save(soft_scene(), folder / "sheets.glb", overwrite=True)
    save(coded_soft_scene(), folder / "coded-sheets.glb", overwrite=True)
    for image, draco in (("png", False), ("jpeg", True), ("webp", False)):
        write_glb(coded_scene(), folder / f"plain-{image}.glb", at=(0.5, 0), image=image, draco=draco, overwrite=True)
    write_glb(soft_scene(), folder / "plain-sheets.glb", overwrite=True)
    for name, scene in (("splats", coded_scene()), ("splats-sheets", soft_scene())):
        write_splats(scene, folder / f"{name}.glb", splats=2000, overwrite=True)
    save(numbered_clip(), folder / "clip.glb", overwrite=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
