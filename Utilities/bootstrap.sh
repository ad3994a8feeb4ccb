#!/usr/bin/env bash
# Installs the packages of packages.txt that this Debian machine does not have.
set -euo pipefail
cd "$(dirname "$0")"

# The tests' meshes. They belong to libcgal-demo, but slim Debian images leave out all of
# /usr/share/doc: there the package is installed, or counts as installed, without them.
meshes=/usr/share/doc/libcgal-dev/data.tar.gz

missing=()
for package in $(sed 's/#.*//' packages.txt); do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  if [ "$status" != installed ] || [ "$package" = libcgal-demo -a ! -e "$meshes" ]; then
    missing+=("$package")
  fi
done
if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi

echo "Installing: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update
# None of them is installed but the meshes' package, if it came without the meshes.
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install --yes --no-install-recommends --reinstall \
  -o Dpkg::Options::="--path-include=$meshes" "${missing[@]}"
if [ ! -e "$meshes" ]; then
  echo "$0: libcgal-demo is installed, but its $meshes is not there." >&2
  exit 1
fi
