# docker build -t microslip .
# docker run --rm -v "$PWD:/work" microslip point transverse --velocity 0.1 --amplitude 1
# docker run --rm -v "$PWD:/work" microslip sweep -j2
FROM python:3.12-slim

COPY . /source
RUN /source/containers/install.sh /source /opt/microslip && rm -rf /source

# The user of the container writes compiled kernels and results, so these folders are outside the image.
ENV PATH=/opt/microslip/bin:$PATH XDG_CACHE_HOME=/tmp/cache
WORKDIR /work
ENTRYPOINT ["microslip"]
CMD ["--help"]
