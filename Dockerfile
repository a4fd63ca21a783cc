# The release binary stands alone: the second stage holds it, a user without rights, and a data volume.
FROM rust:1.95-bookworm AS build
COPY --from=node:20-bookworm-slim /usr/local/bin/node /usr/local/bin/node
COPY --from=node:20-bookworm-slim /usr/local/lib/node_modules /usr/local/lib/node_modules
RUN ln -sf ../lib/node_modules/npm/bin/npm-cli.js /usr/local/bin/npm
WORKDIR /src
COPY . .
RUN cargo build --release --package kelir --locked

FROM debian:bookworm-slim
RUN useradd --system --uid 10001 --create-home kelir && mkdir /data && chown kelir /data
COPY --from=build /src/target/release/kelir /usr/local/bin/kelir
USER kelir
VOLUME /data
EXPOSE 8080
ENTRYPOINT ["kelir"]
CMD ["serve", "--data", "/data", "--listen", "0.0.0.0:8080"]
