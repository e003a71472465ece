#!/usr/bin/env bash
# What builds and runs images here, to be sourced: Docker where its daemon answers, else Podman and
# Buildah, whose images and volumes then lie in a folder of their own.
#
#   choose_engine      sets `engine` to docker or podman, and installs the latter where it is missing
#   provide_base IMAGE has the base image: present, pulled, or made of Debian's packages
#   build_image TAG [BUILD OPTION ...]   from the Dockerfile in this folder
#
# LPF_CONTAINER_DIR names the folder (/tmp/lpf-containers).
containers=${LPF_CONTAINER_DIR:-/tmp/lpf-containers}
engine=

choose_engine() {
    if command -v docker >/dev/null && docker info >/dev/null 2>&1; then
        engine=docker
        return
    fi
    engine=podman
    install_podman
    [ "$(id -u)" -ne 0 ] || configure_podman
    podman info >/dev/null
}

install_podman() {
    local tool missing=no
    for tool in podman buildah runc debootstrap; do
        command -v "$tool" >/dev/null || missing=yes
    done
    [ "$missing" = yes ] || return 0
    if [ "$(id -u)" -ne 0 ] || ! command -v apt-get >/dev/null; then
        echo "Neither Docker's daemon nor Podman and Buildah are here; please install one of them." >&2
        return 1
    fi
    echo "Installing podman, buildah, runc and debootstrap"
    apt-get -q update >/dev/null
    DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600 install -y \
        --no-install-recommends podman buildah runc debootstrap >/dev/null </dev/null
}

# Works within another container, too: no network of its own, and no limits above those there are.
# Paths are short: sockets lie below `run`, and with a name too long for one every end takes 20 s.
configure_podman() {
    mkdir -p "$containers/conf"
    # What ran before a restart of the machine is gone.
    if ! cmp -s /proc/sys/kernel/random/boot_id "$containers/boot"; then
        rm -rf "$containers/run"
        cat /proc/sys/kernel/random/boot_id >"$containers/boot"
    fi
    cat >"$containers/conf/containers.conf" <<TEXT
[containers]
default_ulimits = ["nofile=20000:20000", "nproc=4096:4096"]
netns = "host"
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
events_logger = "file"
TEXT
    cat >"$containers/conf/storage.conf" <<TEXT
[storage]
driver = "overlay"
graphroot = "$containers/storage"
runroot = "$containers/run"
TEXT
    cat >"$containers/conf/registries.conf" <<TEXT
unqualified-search-registries = ["docker.io"]
short-name-mode = "permissive"
TEXT
    export CONTAINERS_CONF=$containers/conf/containers.conf
    export CONTAINERS_STORAGE_CONF=$containers/conf/storage.conf
    export CONTAINERS_REGISTRIES_CONF=$containers/conf/registries.conf
}

provide_base() {
    local image=$1
    "$engine" image inspect "$image" >/dev/null 2>&1 && return
    echo "Pulling $image"
    timeout 120 "$engine" pull -q "$image" >/dev/null 2>&1 && return
    case "$engine-$image" in
        podman-debian:*-slim) make_base "$image" ;;
        *) echo "The base image $image can be neither pulled nor made here." >&2; return 1 ;;
    esac
}

# The same packages as in Debian's own image of this name, from the mirror that apt uses here.
make_base() {
    local image=$1 suite root mirror
    suite=${image#debian:} suite=${suite%-slim}
    root=$containers/$suite
    # shellcheck disable=SC2016  # apt's own substitution
    mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | sed -n 1p)
    echo "No registry is reached; making $image with debootstrap"
    rm -rf "$root"
    debootstrap --variant=minbase --include=ca-certificates "$suite" "$root" "$mirror" \
        >"$containers/debootstrap.log" || { tail -n 20 "$containers/debootstrap.log" >&2; return 1; }
    rm -rf "$root"/usr/share/{doc,man,info,locale}/* "$root"/var/lib/apt/lists/* \
        "$root"/var/cache/apt/*.bin "$root"/var/cache/apt/archives/*.deb "$root"/var/log/*.log
    tar -C "$root" --numeric-owner -c . |
        podman import -q --change 'CMD ["bash"]' - "docker.io/library/$image" >/dev/null
    rm -rf "$root"
}

build_image() {
    local tag=$1
    shift
    if [ "$engine" = docker ]; then
        DOCKER_BUILDKIT=0 docker build -q -t "$tag" "$@" . >/dev/null
    elif [ "$(id -u)" -eq 0 ]; then
        buildah bud --isolation chroot --network host --pull-never --format docker --layers \
            -t "$tag" "$@" .
    else
        podman build --format docker --layers -t "$tag" "$@" .
    fi
}
