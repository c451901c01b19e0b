#!/usr/bin/env bash
# Writes the requirements with hashes that the workflows install, from constraints.txt. It needs uv (`pip install uv`).
set -euo pipefail
cd "$(dirname "$0")/.."
lock() {
  uv pip compile --quiet --universal --python-version 3.11.5 --generate-hashes --no-header --no-annotate \
    --constraint constraints.txt pyproject.toml "${@:2}" --output-file "packaging/requirements-$1.txt"
}
lock run
lock test --extra test --extra benchmark --extra report --extra docs
lock lint --extra lint
lock release --extra release
echo "bpy==5.0.1" | uv pip compile --quiet --python-version 3.11 --generate-hashes --no-header --no-annotate - \
  --output-file packaging/requirements-bpy.txt  # for the Blender add-on's tests
