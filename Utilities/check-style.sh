#!/usr/bin/env bash
# Checks the style of the sources: clang-format, codespell, the sentences of documents (check-prose.sh),
# the layout of the sources (check-layout.py), a licence line in each file, and clang-tidy on what has
# changed since a revision. Needs a build folder for clang-tidy alone.
#   check-style.sh [REVISION]        the revision before the last one when none is given
#   check-style.sh --fix             formats the C++ sources, and checks nothing
# SPDX-License-Identifier: BSD-3-Clause
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

if [[ "${1:-}" == --help ]]; then
  sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
cd "$RepositoryRoot"
if ! git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
  say "This is no repository of git, which lists the sources: the style is not checked."
  exit 0
fi
# Files whose bytes are the point: made by old versions, and inputs of the fuzzers.
data='(/Golden/|/Seeds/|\.(png|svg)$)'
mapfile -t sources < <(git ls-files '*.cxx' '*.h' '*.txx')
mapfile -t texts < <(git ls-files | grep -vE "$data")
mapfile -t licensed < <(git ls-files '*.cxx' '*.h' '*.txx' '*.py' '*.sh' '*.xml' '*.xml.in' '*.cmake' '*CMakeLists.txt')

if [[ "${1:-}" == --fix ]]; then
  clang-format -i "${sources[@]}"
  exit 0
fi

failures=()
check()
{
  local what="$1"
  shift
  if [[ "$(type -t "$1")" == "" ]]; then
    say "Not checked: $1 is missing; Utilities/install-dependencies.sh --with-checks installs it."
    return 0
  fi
  say "Checking: $what"
  "$@" >&2 || failures+=("$what")
}

every_file_names_its_licence()
{
  ! grep -L 'SPDX-License-Identifier: BSD-3-Clause' "${licensed[@]}" | grep . >&2
}

# Sources that have changed; those whose headers did are not looked for.
changed_sources_are_tidy()
{
  local since="${1:-HEAD~1}" changed=()
  if [[ ! -f "$BuildFolder/compile_commands.json" || "$(type -t clang-tidy)" == "" ]] || ! git rev-parse -q --verify "$since^{commit}" >/dev/null; then
    say "clang-tidy has nothing to compare: no build folder, no revision $since, or no clang-tidy."
    return 0
  fi
  mapfile -t changed < <(git diff --name-only --diff-filter=AM "$since" -- '*.cxx' | grep -v '^Testing/')
  # A reformatting of all sources is no change to look at.
  if [[ ${#changed[@]} == 0 || ${#changed[@]} -gt 60 ]]; then
    say "clang-tidy: ${#changed[@]} sources have changed; 1 to 60 are looked at."
    return 0
  fi
  printf '%s\0' "${changed[@]}" |
    xargs -0 -n 1 -P "$(nproc)" clang-tidy -p "$BuildFolder" --quiet --warnings-as-errors='*' 2>/dev/null
}

check "clang-format" clang-format --dry-run -Werror "${sources[@]}"
check "codespell" codespell --quiet-level 3 "${texts[@]}"
check "the sentences of documents" Utilities/check-prose.sh
check "the layout of the sources" Utilities/check-layout.py
check "a licence line in every file" every_file_names_its_licence
check "clang-tidy" changed_sources_are_tidy "${1:-}"
if [[ ${#failures[@]} -gt 0 ]]; then
  fail "the style of the sources is not as it should be: $(printf '%s; ' "${failures[@]}")see above."
fi
say "The style is as it should be."
