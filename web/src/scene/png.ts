import { saveBlob } from "../state/files";

/** Save the canvas with its labels. */
export async function savePng(): Promise<void> {
  const scene = document.querySelector<HTMLElement>(".scene");
  const drawn = scene?.querySelector("canvas");
  if (!scene || !drawn) return;
  const canvas = document.createElement("canvas");
  canvas.width = drawn.width;
  canvas.height = drawn.height;
  const pen = canvas.getContext("2d");
  if (!pen) return;
  pen.drawImage(drawn, 0, 0);
  const scale = drawn.width / drawn.clientWidth;
  pen.scale(scale, scale);
  const origin = drawn.getBoundingClientRect();
  for (const note of scene.querySelectorAll<HTMLElement>(".note > span")) drawNote(pen, note, origin);
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
  if (blob) saveBlob("tarsus.png", blob);
}

/** Draw a label like the page does: background, dot, text. */
function drawNote(pen: CanvasRenderingContext2D, note: HTMLElement, origin: DOMRect): void {
  const box = note.getBoundingClientRect();
  const style = getComputedStyle(note);
  if (box.width === 0 || style.visibility === "hidden") return;
  const [x, y] = [box.left - origin.left, box.top - origin.top];
  pen.fillStyle = style.backgroundColor;
  pen.beginPath();
  pen.roundRect(x, y, box.width, box.height, box.height / 2);
  pen.fill();
  let left = x + parseFloat(style.paddingLeft);
  const dot = note.querySelector("i");
  if (dot) {
    pen.fillStyle = getComputedStyle(dot).backgroundColor;
    pen.beginPath();
    pen.arc(left + 4, y + box.height / 2, 4, 0, 2 * Math.PI);
    pen.fill();
    left += 12;
  }
  pen.fillStyle = style.color;
  pen.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  pen.textBaseline = "middle";
  pen.fillText(note.textContent.trim(), left, y + box.height / 2 + 0.5);
}
