"""Encode a folder of photographs into one .glb, and say how good it is. The photographs are all that is needed.

python examples/01_encode_folder.py [FOLDER]
"""

from __future__ import annotations

import data
import eigenfield as ef

place = data.folder()
photographs = data.capture(place)  # or the path of your own

scene = ef.encode(photographs, preset="small")  # cameras, where a folder holds none, then a surface, then the textures
scene.save(place / "scene.glb", overwrite=True)

figures = ef.evaluate(scene, photographs)["image"]["encoded"]
size = (place / "scene.glb").stat().st_size
print(f"{len(scene.names)} photographs in {size / 1e3:.0f} kB, drawn again with {figures['psnr']:.1f} dB")
