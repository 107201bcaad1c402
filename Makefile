# Everything a newcomer needs. `make` alone lists the targets.

MISSION ?= fire-warehouse
ARGS ?=
SAMPLE ?= 300
BIN := .venv/bin

.DEFAULT_GOAL := help
.PHONY: help demo test setup setup-run fix check bench table mutants docs results ci clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-9s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: setup-run ## fly a mission of the paper and show it (MISSION=fire-warehouse or medicine, ARGS="--headless --seed 3")
	@$(BIN)/mintpilot demo $(MISSION) $(ARGS)

test: setup ## run the quick tests (ARGS="-m long": those that take seconds; ARGS="-m slow": those that take minutes)
	@$(BIN)/python -m pytest $(ARGS)

setup: ## make .venv and install everything, the developer's tools included; quick when nothing changed
	@scripts/setup.sh dev

setup-run:
	@scripts/setup.sh run

fix: setup ## format, and mend what can be mended
	@$(BIN)/ruff format
	@$(BIN)/ruff check --fix

check: setup ## formatting, lint, types and import rules
	@$(BIN)/ruff format --check
	@$(BIN)/ruff check
	@$(BIN)/mypy
	@$(BIN)/lint-imports

bench: setup ## measure search and questions against their yardsticks, and write docs/results.md (BENCH=--quick: a taste)
	@$(BIN)/python -m bench.search $(BENCH)
	@$(BIN)/python -m bench.questions $(BENCH)
	@$(BIN)/python -m bench.choices $(BENCH)

results: bench ## measure everything that docs/results.md states but the tables of strategies, and write it
	@$(BIN)/python -m bench.missions --seeds 20 --keep
	@$(BIN)/python -m bench.language
	@for by in typed voice; do $(BIN)/python -m bench.answers --by $$by || exit 1; done

table: setup ## fly Table 1, the boxes and the gaps as far as no record is there yet (hours), and write docs/results.md
	@for part in table1 boxes gaps; do $(BIN)/python -m bench.$$part || exit 1; done

mutants: setup ## try small faults against the tests (SAMPLE=300; goes on where it stopped) and write docs/results.md
	@[ -f runs/mutants/map.json ] || $(BIN)/python -m bench.mutants --map
	@$(BIN)/python -m bench.mutants --sample $(SAMPLE) --keep

docs: setup ## generate docs/cli.md, docs/mission-file.md and the schema, and build the site into site/
	@$(BIN)/python scripts/make_docs.py
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet
	@$(BIN)/python scripts/check_site.py site

ci: ## what the continuous integration runs
	@.ci/run

clean: ## remove .venv, caches and runs
	@rm -rf .venv runs site .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	@find src tests bench -name __pycache__ -type d -prune -exec rm -rf {} +
