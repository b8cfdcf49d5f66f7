# photohull in a container: docker build -t photohull . && docker run --rm -v "$PWD:/work" photohull demo --out temple
FROM debian:12 AS build
COPY . /photohull
WORKDIR /photohull
RUN apt-get update && apt-get install --yes --no-install-recommends python3-dev python3-numpy pybind11-dev dpkg-dev file \
    && scripts/setup.sh --target installed \
    && cd build/release && cpack -G DEB -B /packages

FROM debian:12-slim
COPY --from=build /packages/*.deb /packages/
RUN apt-get update \
    && apt-get install --yes --no-install-recommends /packages/photohull_*.deb /packages/libphotohull*.deb /packages/python3-photohull_*.deb \
    && rm -rf /packages /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["photohull"]
CMD ["--help"]
