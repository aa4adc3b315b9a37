#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make_sysroot.sh ARCHITECTURE FOLDER PACKAGE...
# Unpacks Debian packages of another architecture, and all that they depend on, into a folder to
# compile against. Leaves the machine's own packages alone: some of them could not stand beside
# those of another architecture. Takes the machine's package sources. Quick when nothing changed.
set -euo pipefail
architecture=$1
folder=$2
shift 2

if [[ -e $folder/packages && $(<"$folder/packages") == "$*" ]]; then
    exit 0
fi
rm -rf "$folder"
mkdir -p "$folder"/apt/{state/lists/partial,cache/archives/partial} "$folder/root"
folder=$(cd "$folder" && pwd)
: >"$folder/apt/status"

apt() {
    apt-get -qq -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" \
        -o Dir::State="$folder/apt/state" -o Dir::State::status="$folder/apt/status" \
        -o Dir::Cache="$folder/apt/cache" -o APT::Sandbox::User=root -o Debug::NoLocking=1 \
        -o APT::Install-Recommends=0 "$@"
}

apt update
apt install -y --download-only "$@" >/dev/null
# Debian's / is merged into /usr; packages still unpack into both.
mkdir -p "$folder"/root/usr/{bin,sbin,lib}
ln -s usr/bin usr/sbin usr/lib "$folder/root/"
for package in "$folder"/apt/cache/archives/*.deb; do
    dpkg-deb --fsys-tarfile "$package" | tar -x --keep-directory-symlink --no-same-owner \
        -C "$folder/root" --exclude './usr/share/doc' --exclude './usr/share/man'
done
rm -rf "$folder/apt"
# Links that lead from the root must lead within the folder.
find "$folder/root" -type l -lname '/*' -print0 | while IFS= read -r -d '' link; do
    ln -sfn "$folder/root$(readlink "$link")" "$link"
done
echo "$*" >"$folder/packages"
