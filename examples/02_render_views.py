"""Draw a scene from cameras, from between them, and as a film.

python examples/02_render_views.py [FOLDER]
"""

from __future__ import annotations

import numpy as np

import data
import eigenfield as ef

place = data.folder()
scene = ef.load(data.scene(place))

scene.render(camera=scene.names[0]).save(place / "camera.png", overwrite=True)  # where a photograph was taken
scene.render(at=(0.3, -0.2)).save(place / "between.png", overwrite=True)  # X right, Y up; ±1 are the array's edges

angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
circle = 0.8 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
frames = np.stack([picture.to_uint8() for picture in ef.render_many(scene, at=circle)])
print(f"{len(frames)} pictures of {frames.shape[2]}x{frames.shape[1]} pixels, drawn as arrays")

ef.export(scene, place / "flight.mp4", frames=12, overwrite=True)  # the same as a film
