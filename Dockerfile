# An image of sweepscope on Debian 12: the packages that CPack makes, and a user without rights.
#   docker build -t sweepscope .
#   docker run --rm -v "$PWD:/data" sweepscope sweepscope estimate REC.bag
# tests/package/image runs the steps of the last stage without Docker.
FROM debian:12 AS build
WORKDIR /sweepscope
COPY .ci .ci
RUN .ci/install-packages --to-build
COPY . .
RUN cmake --preset release -DBUILD_TESTING=OFF
RUN cmake --build --preset release
RUN cpack --config build/CPackConfig.cmake -B build/packages

FROM debian:12-slim
COPY --from=build /sweepscope/build/packages/ /packages/
RUN apt-get update \
 && apt-get install -y --no-install-recommends /packages/sweepscope_*.deb /packages/python3-sweepscope_*.deb \
 && rm -rf /packages /var/lib/apt/lists/*
RUN useradd --create-home --uid 1000 sweepscope
USER sweepscope
WORKDIR /data
CMD ["sweepscope"]
