import { useEffect, useMemo } from "react";
import { CanvasTexture, LinearFilter } from "three";

interface Props {
  text: string;
  at: readonly [number, number];
  colour: string;
}

/** Text on the ground, to be read from behind the robot. */
export function GridLabel({ text, at, colour }: Props) {
  const texture = useMemo(() => textTexture(text, colour), [text, colour]);
  useEffect(() => () => texture.dispose(), [texture]);
  return (
    <mesh position={[at[0] - 14, at[1] - 26, 0.4]} rotation={[0, 0, -Math.PI / 2]}>
      <planeGeometry args={[64, 16]} />
      <meshBasicMaterial map={texture} transparent depthWrite={false} toneMapped={false} />
    </mesh>
  );
}

// Drawn on a canvas in the font of the page: a WebGL font would have to be downloaded.
function textTexture(text: string, colour: string): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = 256;
  canvas.height = 64;
  const pen = canvas.getContext("2d");
  if (pen) {
    pen.font = "500 52px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillStyle = colour;
    pen.fillText(text, 128, 34);
  }
  const texture = new CanvasTexture(canvas);
  texture.minFilter = LinearFilter;
  texture.anisotropy = 8;
  return texture;
}
