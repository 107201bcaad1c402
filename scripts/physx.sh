#!/usr/bin/env bash
# An environment with NVIDIA PhysX for one slow test. It is apart from .venv: ovphysx wants an older 'packaging' than pytest.
# Its packages stand under NVIDIA's own licence.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

python3 -m venv .venv-physx
.venv-physx/bin/pip install --quiet 'ovphysx>=0.7' 'ovstage>=0.3' 'physx-usd-schemas>=25.11' 'newton-usd-schemas>=0.6'
echo "Now run: make test ARGS='-m slow tests/simulation/test_openusd.py'"
