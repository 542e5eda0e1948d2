# docker build -t hosel . && docker run --rm -v "$PWD:/work" hosel run driver-toe
FROM debian:12 AS build
WORKDIR /src
COPY packages.txt ./
COPY scripts/install-packages scripts/
RUN grep -v "^#" packages.txt | xargs scripts/install-packages dpkg-dev lintian
COPY . .
RUN scripts/package

FROM debian:12
COPY --from=build /src/build/package/hosel_*.deb /tmp/
RUN apt-get update -qq && apt-get install -y -qq --no-install-recommends /tmp/hosel_*.deb \
    && rm -rf /tmp/hosel_*.deb /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["hosel"]
CMD ["help"]
