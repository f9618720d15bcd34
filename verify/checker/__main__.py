"""Run the checker: this folder as a program, which has no package then, or as a module."""

import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path


def run() -> int:
    """Check the file named on the command line."""
    if __package__:
        from .command import main

        return main(sys.argv[1:])
    here = Path(__file__).resolve().parent
    sys.path[:] = [entry for entry in sys.path if Path(entry).resolve() != here]
    spec = spec_from_file_location("checker", here / "__init__.py", submodule_search_locations=[str(here)])
    if spec is None or spec.loader is None:
        raise ImportError(f"{here} is not the checker's folder")
    package = module_from_spec(spec)
    sys.modules["checker"] = package
    spec.loader.exec_module(package)
    code: int = package.main(sys.argv[1:])
    return code


sys.exit(run())
