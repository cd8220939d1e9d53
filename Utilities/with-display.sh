#!/usr/bin/env bash
# Runs a command with an X display: the one there is, or a virtual one made for it.
#   with-display.sh COMMAND [ARGUMENTS...]
# Exits with the command's own status. BANYAN_SCREEN is the size and depth of a virtual display
# (default 1600x1200x24).
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail

if [[ $# == 0 || "$1" == --help ]]; then
  sed -n '2,5s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
if [[ -n "${DISPLAY:-}" ]]; then
  exec "$@"
fi
if ! command -v Xvfb >/dev/null; then
  echo "with-display.sh: Xvfb is missing; Utilities/install-dependencies.sh installs it." >&2
  exit 1
fi

scratch="$(mktemp -d)"
server=""
finish()
{
  [[ -z "$server" ]] || kill "$server" 2>/dev/null || true
  rm -rf "$scratch"
}
trap finish EXIT
trap 'exit 143' TERM
trap 'exit 130' INT

# The server picks a free display itself and says which, so that any number of these can start at
# the same time. Without -noreset it would reset whenever its last client leaves, and the next
# process that connects during the reset would abort. It ends with this script, however that ends.
mkfifo "$scratch/number"
setpriv --pdeathsig TERM Xvfb -displayfd 3 -screen 0 "${BANYAN_SCREEN:-1600x1200x24}" \
  -noreset -nolisten tcp 3>"$scratch/number" >"$scratch/log" 2>&1 &
server=$!
if ! read -r -t 30 number <"$scratch/number"; then
  echo "with-display.sh: Xvfb did not start: $(tail -n 1 "$scratch/log")" >&2
  exit 1
fi

status=0
DISPLAY=":$number" "$@" || status=$?
exit "$status"
