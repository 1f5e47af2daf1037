# Sourced: a Debian of its own in a folder, by debootstrap, and commands in it by chroot. Root only.
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}

# own_mounts ARGS…: runs this script once more where its mounts are its own and end with it.
own_mounts() {
  [ -n "${TAPSTUDY_OWN_MOUNTS:-}" ] && return
  TAPSTUDY_OWN_MOUNTS=yes exec unshare --mount --propagation private bash "$0" "$@"
}

# make_root RELEASE FOLDER: unless the folder holds one already.
make_root() {
  if [ ! -e "$2/.made" ]; then
    mkdir -p "$2"
    debootstrap --variant=minbase "$1" "$2" "$mirror" >"$2.log"
    touch "$2/.made"
  fi
  mount -t proc proc "$2/proc"
  mount --rbind /dev "$2/dev"
  printf 'APT::Install-Recommends "false";\n' >"$2/etc/apt/apt.conf.d/90tapstudy"
}

# in_root FOLDER COMMAND…: without the caller's environment.
in_root() {
  local root=$1
  shift
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 TERM=dumb \
    DEBIAN_FRONTEND=noninteractive "$@"
}

# copy_checkout FOLDER: what is committed, as a clone, in FOLDER/tapstudy.
copy_checkout() {
  if [ -d "$1/tapstudy/.git" ]; then
    git -C "$1/tapstudy" fetch -q "$PWD" HEAD
    git -C "$1/tapstudy" checkout -q FETCH_HEAD
  else
    git clone -q --no-hardlinks . "$1/tapstudy"
  fi
}
