# Sourced by the scripts beside it: where the checkout is, how to speak, how to build.

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }
die() { say "$*"; exit 1; }

# Prints the comment block at the head of the calling script as its help text.
usage() { sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$0"; }

# Folder with development scenes and reference values: the environment's, else one named `shared` beside the checkout,
# else nothing (the tests that need it then skip and say so).
sharedFolder() {
  if [[ -n ${DELTALUX_SHARED:-} ]]; then
    [[ -d $DELTALUX_SHARED ]] || die "DELTALUX_SHARED is '$DELTALUX_SHARED', which is not a folder: correct or unset it"
    (cd "$DELTALUX_SHARED" && pwd)
  elif [[ -d $root/../shared ]]; then
    (cd "$root/../shared" && pwd)
  fi
}

# Configures and builds a preset of CMakePresets.json: all of it, or the targets named after it. In CI the library is
# compiled in a few large pieces: nothing is there that an edit could leave standing.
# Sends everything to stderr, so that callers keep stdout for results.
buildPreset() {
  local preset=$1
  shift
  local targets=()
  (($# == 0)) || targets=(--target "$@")
  (
    cd "$root"
    cmake --preset "$preset" -DDELTALUX_SHARED="$(sharedFolder)" ${CI:+-DDELTALUX_UNITY=ON} --log-level=NOTICE
    cmake --build --preset "$preset" --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" "${targets[@]}"
  ) >&2
}
