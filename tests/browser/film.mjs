// Plays a film as a viewer would see it: how large, how long, and the colours of its frame at some instant.
// Argument (JSON): {file, at_s, points: [[x, y], …]}. Last line of output (JSON): {width, height, duration_s, colours: [[r, g, b], …]}.
import { readFileSync } from "node:fs";
import { launch } from "./chromium.mjs";

const task = JSON.parse(process.argv[2]);
const browser = await launch();
try {
  const page = await browser.newPage();
  const type = task.file.endsWith(".mp4") ? "video/mp4" : "image/apng";
  const url = `data:${type};base64,${readFileSync(task.file).toString("base64")}`;
  const seen = await page.evaluate(
    async ({ url, type, task }) => {
      const film = document.createElement(type === "video/mp4" ? "video" : "img");
      film.src = url;
      if (type === "video/mp4") {
        await new Promise((done, failed) => {
          // A frame counts once it is there to be drawn: a seek can end before it is decoded, and the film's first frame comes before any seek.
          const drawn = (_, { mediaTime }) => (Math.abs(mediaTime - task.at_s) < 0.1 ? done() : film.requestVideoFrameCallback(drawn));
          film.requestVideoFrameCallback(drawn);
          film.onerror = () => failed(new Error(film.error?.message ?? "the film does not play"));
          film.onloadedmetadata = () => (film.currentTime = task.at_s);
        });
      } else await film.decode();
      const [width, height] = [film.videoWidth ?? film.naturalWidth, film.videoHeight ?? film.naturalHeight];
      const canvas = new OffscreenCanvas(width, height).getContext("2d");
      canvas.drawImage(film, 0, 0);
      const colours = task.points.map(([x, y]) => [...canvas.getImageData(x, y, 1, 1).data].slice(0, 3));
      return { width, height, duration_s: film.duration ?? null, colours };
    },
    { url, type, task },
  );
  console.log(JSON.stringify(seen));
} finally {
  await browser.close();
}
