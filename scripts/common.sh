# shellcheck shell=bash
# For the other scripts to source: goes to the repository's root and tells how parallel a build may be.
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
step() { printf '\n== %s\n' "$*"; }

# Compilers at once: one a core, and no more than memory has room for (the largest sources take about 1.5 GiB each).
parallel_jobs() {
  local cores room
  cores=$(nproc)
  room=$(awk '/^MemAvailable:/ { print int($2 / 1572864) }' /proc/meminfo)
  [ "${room:-1}" -ge 1 ] || room=1
  echo $((cores < room ? cores : room))
}
