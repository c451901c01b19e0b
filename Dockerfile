# docker build --build-arg VERSION=1.2.3 -t eigenfield .
# docker run --rm -v "$PWD:/work" -v eigenfield-cache:/home/eigenfield/.cache eigenfield encode photos/ -o scene.glb
# The second volume keeps the kernels that the first run compiles for its processor.
FROM python:3.13-slim AS build
COPY . /source
WORKDIR /source
ARG VERSION=0.0.0
RUN python -m venv /opt/eigenfield \
    && /opt/eigenfield/bin/pip install --no-cache-dir --require-hashes -r packaging/requirements-run.txt \
    && python -m venv /opt/tools \
    && /opt/tools/bin/pip install --no-cache-dir --require-hashes -r packaging/requirements-release.txt \
    && SETUPTOOLS_SCM_PRETEND_VERSION=$VERSION /opt/tools/bin/python -m build --no-isolation --wheel --outdir /dist \
    && /opt/eigenfield/bin/pip install --no-cache-dir --no-deps /dist/*.whl

FROM python:3.13-slim
COPY --from=build /opt/eigenfield /opt/eigenfield
RUN useradd --create-home --uid 1000 eigenfield && install -d -o eigenfield /home/eigenfield/.cache
USER 1000
ENV PATH=/opt/eigenfield/bin:$PATH
WORKDIR /work
# the viewer: docker run --rm -p 8000:8000 -v "$PWD:/work" eigenfield view --host 0.0.0.0 --port 8000 --no-browser scene.glb
EXPOSE 8000
ENTRYPOINT ["eigenfield"]
CMD ["--help"]
