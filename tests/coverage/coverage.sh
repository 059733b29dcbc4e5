#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Reports lines of include/ and src/ that the tests execute, per file and in total. Usage:
# bash tests/coverage/coverage.sh [--report]
# --report: reports the last run instead of running the tests again. A line of a template counts
# once, and as executed if any instance of the template executes it. A line of a template that no
# test instantiates is not compiled and not counted.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root"
build=$root/build/coverage
tools=$root/.deps/coverage
pins=$root/tests/coverage/requirements.txt

if ! cmp -s "$pins" "$tools/installed"; then
  rm -rf "$tools"
  python3 -m pip install --quiet --no-compile --no-deps --target "$tools" -r "$pins"
  cp "$pins" "$tools/installed"
fi

status=0
if [ "${1:-}" != --report ]; then
  find "$build" -name '*.gcda' -delete 2>/dev/null || true
  bash cmake/bootstrap.sh test --preset coverage || status=$?
fi
mkdir -p "$build/lines"
PYTHONPATH=$tools python3 -m gcovr --root "$root" -j "$(nproc)" \
  --filter "$root/include/" --filter "$root/src/" --merge-mode-functions separate \
  --gcov-ignore-parse-errors=negative_hits.warn_once_per_file --gcov-suspicious-hits-threshold=0 \
  --json "$build/lines/lines.json" --txt "$build/lines/lines.txt" "$build"
cat "$build/lines/lines.txt"
exit "$status"
