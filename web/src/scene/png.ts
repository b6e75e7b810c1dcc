import { saveBlob } from "../state/files";

/** Save what the canvas shows now. */
export async function savePng(): Promise<void> {
  const canvas = document.querySelector<HTMLCanvasElement>(".scene canvas");
  if (!canvas) return;
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
  if (blob) saveBlob("tarsus.png", blob);
}
