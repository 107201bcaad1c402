#!/usr/bin/env bash
# Pins every package that `make setup` installs, for all platforms, by hash: requirements/run.txt and requirements/dev.txt.
# Wants uv, anywhere: pip install uv.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

pin() {
    local level=$1
    shift
    uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-header --no-annotate \
        --no-emit-index-url --output-file "requirements/$level.txt" pyproject.toml requirements/build.in "$@"
}

pin run --extra sim --extra console
pin dev --extra sim --extra dev --extra bench --extra docs
