"""What pyproject.toml cannot say: a wheel holds the pages that `eigenfield help` shows."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py


class BuildWithPages(build_py):
    def run(self) -> None:
        super().run()
        if not self.editable_mode:
            pages = Path(self.build_lib) / "eigenfield" / "docs"
            pages.mkdir(parents=True, exist_ok=True)
            for page in Path("docs").glob("*.md"):
                shutil.copy(page, pages)


setup(cmdclass={"build_py": BuildWithPages})
