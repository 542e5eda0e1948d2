"""Build backend of `pip install .`: CMake builds the module, this packs it into a wheel.

Uses the build folder build/release (HOSEL_BUILD names another), so that what is compiled already is not compiled again.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent


def _configured_for(build):
    """The interpreter that a build folder compiles the module for."""
    cache = build / "CMakeCache.txt"
    found = re.search(r"^Python_EXECUTABLE:\w+=(.+)$", cache.read_text() if cache.exists() else "", re.MULTILINE)
    return found and os.path.realpath(found[1])


def _compiled():
    build = Path(os.environ.get("HOSEL_BUILD", ROOT / "build" / "release"))
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    # The interpreter behind a virtual environment: CMake remembers it, and the environment may go.
    python = f"-DPython_EXECUTABLE={os.path.realpath(sys.executable)}"
    module = build / "python" / "hosel" / f"_hosel{suffix}"
    if not module.exists() or _configured_for(build) != os.path.realpath(sys.executable):
        subprocess.run(["cmake", "--preset", "release", "-B", build, python], cwd=ROOT, check=True)
    subprocess.run(["cmake", "--build", build, "--target", "hosel_python"], cwd=ROOT, check=True)
    return module


def _hashed(data):
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    module = _compiled()
    tag = "cp{0}{1}-cp{0}{1}-{2}".format(*sys.version_info[:2], sysconfig.get_platform().replace("-", "_").replace(".", "_"))
    info = f"{project['name']}-{project['version']}.dist-info"
    files = {f"hosel/{f.name}": f.read_bytes() for f in sorted((HERE / "hosel").glob("*.py"))}
    files[f"hosel/{module.name}"] = module.read_bytes()
    needs = "".join(f"Requires-Dist: {d}\n" for d in project["dependencies"])
    files[f"{info}/METADATA"] = (
        f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
        f"Summary: {project['description']}\nRequires-Python: {project['requires-python']}\n{needs}"
    ).encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: hosel\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = "".join(f"{name},{_hashed(data)},{len(data)}\n" for name, data in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    name = f"{project['name']}-{project['version']}-{tag}.whl"
    with zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            wheel.writestr(path, data)
    return name
