"""check.py RECIPE SOURCE: checks a recipe of format 1: its keys, its requirements, and that its licence files exist."""
import pathlib
import sys

import yaml

recipe = yaml.safe_load(open(sys.argv[1], encoding="utf-8"))
source = pathlib.Path(sys.argv[2])
KEYS = {"schema_version", "context", "package", "source", "build", "requirements", "tests", "about", "extra"}

assert recipe["schema_version"] == 1
assert set(recipe) <= KEYS, set(recipe) - KEYS
assert set(recipe["package"]) == {"name", "version"}
assert recipe["context"]["version"] in (source / "src/base/version.h").read_text()
assert len(recipe["source"]["sha256"]) == 64 and set(recipe["source"]["sha256"]) > {"a"}, "no hash of the release"
assert set(recipe["build"]) <= {"number", "skip", "script", "noarch", "string"}
assert (source / ".ci/packages/conda" / recipe["build"]["script"]["file"]).exists()
assert set(recipe["requirements"]) <= {"build", "host", "run", "run_constraints", "ignore_run_exports"}
assert all(isinstance(word, str) for part in recipe["requirements"].values() for word in part)
assert any("script" in test for test in recipe["tests"])
for name in recipe["about"]["license_file"]:
    assert (source / name).is_file(), f"there is no {name}"
