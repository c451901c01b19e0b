"""Put a scene into a page of your own: one file for any web server, shown in a frame.

python examples/04_embed_in_page.py [FOLDER]
"""

from __future__ import annotations

import data
import eigenfield as ef

place = data.folder()
written, what = ef.export(data.scene(place), place / "scene.html", title="A small array", overwrite=True)
print(f"{written}: {what}")

(place / "index.html").write_text(
    """<!doctype html>
<title>A page of yours</title>
<p>Move the pointer over the picture, or turn the phone.</p>
<iframe src="scene.html" title="A small array" width="640" height="480" style="border: 0" allow="fullscreen"></iframe>
""",
    encoding="utf-8",
)
print(f"open {place / 'index.html'} in a browser")
