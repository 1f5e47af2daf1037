# Sourced: a Debian of its own in a folder, by debootstrap, and commands in it by chroot. Root only.
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}

# own_mounts ARGS…: runs this script once more where its mounts are its own and end with it.
own_mounts() {
  [ -n "${TAPSTUDY_OWN_MOUNTS:-}" ] && return
  TAPSTUDY_OWN_MOUNTS=yes exec unshare --mount --propagation private bash ".ci/$(basename "$0")" "$@"
}

# make_root RELEASE [FOLDER]: sets root. A folder given is kept, and gone on with if it holds one
# already; else the root is a temporary one. Sets scratch, a temporary folder, too.
make_root() {
  scratch=$(mktemp -d)
  root=${2:-$scratch/root}
  trap 'umount -R "$root/dev" "$root/proc"; rm -rf --one-file-system "$scratch"' EXIT
  mkdir -p "$root"
  if [ ! -e "$root/.made" ]; then
    debootstrap --variant=minbase "$1" "$root" "$mirror" >"$scratch/debootstrap.log"
    touch "$root/.made"
  fi
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  printf 'APT::Install-Recommends "false";\n' >"$root/etc/apt/apt.conf.d/90tapstudy"
}

# in_root COMMAND…: without the caller's environment.
in_root() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 TERM=dumb \
    DEBIAN_FRONTEND=noninteractive "$@"
}

# copy_checkout: what is committed, as a clone, in /tapstudy of the root.
copy_checkout() {
  [ -d "$root/tapstudy/.git" ] || git clone -q --no-hardlinks . "$root/tapstudy"
  git -C "$root/tapstudy" fetch -q "$PWD" HEAD
  git -C "$root/tapstudy" checkout -q FETCH_HEAD
}
