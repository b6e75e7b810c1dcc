import { useEffect, useMemo } from "react";
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  LinearMipmapLinearFilter,
  RepeatWrapping,
} from "three";

import type { TerrainMessage } from "../protocol";
import type { Palette } from "./palette";
import { surfaceOf } from "./terrain";

interface Props {
  terrain: TerrainMessage;
  palette: Palette;
}

/** Pixels of the picture of a square of the grid; its first ones are the line. */
const PIXELS = 64;

/** The terrain as the physics engine has it, with a grid of 100 mm on it. */
export function TerrainModel({ terrain, palette }: Props) {
  const geometry = useMemo(() => {
    const { positions, uvs } = surfaceOf(terrain);
    const made = new BufferGeometry();
    made.setAttribute("position", new BufferAttribute(positions, 3));
    made.setAttribute("uv", new BufferAttribute(uvs, 2));
    made.computeVertexNormals();
    return made;
  }, [terrain]);
  const grid = useMemo(gridTexture, []);
  useEffect(() => () => geometry.dispose(), [geometry]);
  useEffect(() => () => grid.dispose(), [grid]);
  return (
    <mesh geometry={geometry} receiveShadow name="terrain">
      <meshStandardMaterial color={palette.terrain} map={grid} roughness={0.95} flatShading />
    </mesh>
  );
}

/** A bright square with a darker line along two of its edges. */
function gridTexture(): DataTexture {
  const pixels = new Uint8Array(PIXELS * PIXELS * 4).fill(255);
  for (let i = 0; i < PIXELS * PIXELS; i++) {
    const line = i % PIXELS === 0 || i < PIXELS;
    if (line) pixels.fill(168, i * 4, i * 4 + 3);
  }
  const texture = new DataTexture(pixels, PIXELS, PIXELS);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  return texture;
}
