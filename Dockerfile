# Tarsus Studio for visitors: docker build -t tarsus-studio . && docker run --rm -p 8600:8600 tarsus-studio
FROM python:3.12-slim AS build
WORKDIR /tarsus
COPY . .
# The build fetches a Node of its own for the pages; nothing of it comes into the image below.
RUN pip wheel --no-cache-dir --wheel-dir /wheels --constraint constraints.txt '.[sim,studio]'

FROM python:3.12-slim
COPY --from=build /wheels /wheels
RUN pip install --no-cache-dir --no-index --find-links /wheels 'tarsus[sim,studio]' \
    && rm -rf /wheels \
    && useradd --system --no-create-home tarsus
USER tarsus
EXPOSE 8600
HEALTHCHECK --interval=30s --timeout=5s --start-period=20s \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8600/health', timeout=4)"]
CMD ["tarsus", "studio", "--host", "0.0.0.0", "--port", "8600", "--public", "--no-browser"]
