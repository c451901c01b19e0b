"""Which browsers are here, and the remedy where one is not."""

from __future__ import annotations

import os
import shutil

CHROMIUM = os.environ.get("EIGENFIELD_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
OTHERS = {  # engines beside Chromium: any of these programs, and the remedy
    "firefox": (["firefox-esr", "firefox"], "needs Firefox: apt-get install firefox-esr xvfb"),
    "webkit": (["WebKitWebDriver"], "needs WebKitGTK: apt-get install webkit2gtk-driver xvfb"),
}


def lacks(engine: str) -> str | None:
    """The remedy where an engine beside Chromium is not here."""
    programs, remedy = OTHERS[engine]
    screen = os.environ.get("DISPLAY") or shutil.which("Xvfb")
    return None if screen and any(map(shutil.which, programs)) else remedy
