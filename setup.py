"""The example programs go into the package when it is built; in a clone they lie beside it."""

from pathlib import Path
from shutil import copytree

from setuptools import setup
from setuptools.command.build_py import build_py


class BuildWithExamples(build_py):
    """Copies the examples to where `desire_tui.common.paths.examples_folder` looks for them."""

    def run(self) -> None:
        """Build as always, then copy; an editable install uses the clone's own."""
        super().run()
        if not self.editable_mode:
            copytree("examples", Path(self.build_lib) / "desire_tui" / "examples", dirs_exist_ok=True)


setup(cmdclass={"build_py": BuildWithExamples})
