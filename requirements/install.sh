#!/bin/sh
# What development needs, into a virtual environment: install.sh LOCK PIP-INSTALL-COMMAND...
# The versions of LOCK, each with its hash; without one, the newest that pyproject.toml allows. A hash
# that does not match ends it. What an index has not, or a system cannot use, is taken newer.
lock=$1
shift
if [ -n "$lock" ]; then
  said=$(mktemp)
  trap 'rm -f "$said"' EXIT
  if "$@" --require-hashes -r "$lock" 2>"$said"; then
    "$@" --no-deps --no-build-isolation . || exit 1
    "$@" --require-hashes -r requirements/exudyn.txt || echo 'without Exudyn'
    exit 0
  fi
  cat "$said" >&2
  if grep -q 'DO NOT MATCH THE HASHES' "$said"; then
    echo "error: a package is not the one that $lock names" >&2
    exit 1
  fi
  echo "the versions of $lock cannot be had here: the newest that are allowed"
fi
"$@" '.[lab,exudyn,dev]' -r requirements/tools.in && exit 0
echo 'again, without Exudyn'
"$@" '.[lab,dev]' -r requirements/tools.in
