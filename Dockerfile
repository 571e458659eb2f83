# docker build -t gearcad . && docker run --rm -v "$PWD":/work gearcad data pair.toml
#
# The image contains gmsh, which is GPL: who passes it on does so under the GPL (LICENSES.md).

FROM debian:12-slim AS build
RUN apt-get update -q && apt-get install -qy --no-install-recommends git python3-venv
COPY . /src
RUN python3 -m venv /opt/gearcad && /opt/gearcad/bin/pip install -q --no-cache-dir "/src[mesh,page,xlsx]"

FROM debian:12-slim
RUN apt-get update -q && apt-get install -qy --no-install-recommends python3 \
    libgl1 libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1 libfontconfig1 libegl1 libgomp1 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/gearcad /opt/gearcad
ENV PATH=/opt/gearcad/bin:$PATH MPLCONFIGDIR=/tmp/matplotlib NUMBA_CACHE_DIR=/tmp/numba
WORKDIR /work
ENTRYPOINT ["gearcad"]
CMD ["--help"]
