"""Encode many captures with the same options. What is finished is taken up again; a capture that fails has its line.

python examples/05_batch.py [FOLDER]
"""

from __future__ import annotations

import data
import eigenfield as ef

place = data.folder()
(place / "captures").mkdir(exist_ok=True)
for name, columns in (("one", 2), ("two", 3)):
    data.capture(place / "captures", name, columns)

result = ef.batch(place / "captures", place / "scenes", preset="small", surface="relief")
for record in result.records:
    print(f"{record['name']}: {record['bytes'] / 1e3:.0f} kB")
print(f"{result.taken_up} of {len(result.records)} were there already; {result.page} shows all of them")
