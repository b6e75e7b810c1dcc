/** Force on a foot as a label, such as 10.2 N; empty for a foot that carries nothing. */
export function forceText(forces: Float32Array | null, leg: number): string {
  if (!forces) return "";
  const newtons = Math.hypot(...forces.subarray(leg * 3, leg * 3 + 3));
  return newtons < 0.05 ? "" : `${newtons.toFixed(newtons < 100 ? 1 : 0)} N`;
}
