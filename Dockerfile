# The server in an image without a compiler. Ordinary syntax: Docker, Podman and Buildah build it.
#   docker build -t lpf-server .
ARG BASE_IMAGE=debian:bookworm-slim

FROM ${BASE_IMAGE} AS build
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
        g++ cmake ninja-build pkg-config libeigen3-dev libnanoflann-dev libdraco-dev \
        nlohmann-json3-dev libcpp-httplib-dev libssl-dev zlib1g-dev libsqlite3-dev libcli11-dev \
        libseccomp-dev nodejs npm python3-pytest python3-requests python3-jsonschema \
        python3-prometheus-client \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /source
COPY CMakeLists.txt CMakePresets.json LICENSE ./
COPY cmake cmake
COPY core core
COPY api api
COPY server server
COPY client-examples client-examples
RUN cmake --preset release -DLPF_BUILD_TESTS=OFF \
    && cmake --build --preset release --target lpf-server lpf-decode web \
    && cmake --install build/release --component server --strip --prefix /opt/lpf
# The packages of the libraries that the programs are linked with, found by the programs themselves.
RUN ldd /opt/lpf/bin/* \
    | awk '$3 ~ /^\// {print $3}' | sort -u | xargs -r -n1 readlink -f \
    | xargs -r -n1 dpkg-query -S | cut -d: -f1 | sort -u > /opt/packages
# A faulty server gets no image.
COPY tests/e2e tests/e2e
RUN LPF_SERVER_BINARY=/opt/lpf/bin/lpf-server python3 -m pytest -q -p no:cacheprovider \
        tests/e2e/test_service.py tests/e2e/test_processes.py

FROM ${BASE_IMAGE}
COPY --from=build /opt/packages /tmp/packages
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive xargs -a /tmp/packages \
        apt-get install -y --no-install-recommends \
    && rm -rf /var/lib/apt/lists/* /var/cache/* /var/log/* /tmp/packages \
    && mkdir -p /var/lib/lpf && chown 65532:65532 /var/lib/lpf
# The decoder lies beside the server, which looks for it there.
COPY --from=build /opt/lpf/ /usr/local/
ARG VERSION=unknown
ARG COMMIT=unknown
# The labels tell the truth: of the version, and, as Buildah keeps labels of an older build unless a
# command came between, of the commit.
RUN [ "${VERSION}" = unknown ] || [ "$(lpf-server --version)" = "lpf-server ${VERSION}" ]
LABEL org.opencontainers.image.title="LPF Server" \
      org.opencontainers.image.description="Denoises, resamples and analyses 3D shapes over HTTP" \
      org.opencontainers.image.licenses="Apache-2.0" \
      org.opencontainers.image.version="${VERSION}" \
      org.opencontainers.image.revision="${COMMIT}"
ENV LPF_HOST=0.0.0.0 LPF_DATA_DIR=/var/lib/lpf
USER 65532:65532
VOLUME /var/lib/lpf
EXPOSE 8080 8081
STOPSIGNAL SIGTERM
HEALTHCHECK --interval=10s --timeout=5s --start-period=20s --retries=3 \
    CMD ["lpf-server", "--healthcheck"]
ENTRYPOINT ["lpf-server"]
