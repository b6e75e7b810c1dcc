import { useEffect } from "react";

import { setLine, useLine } from "./lines";

interface Props {
  /** For each leg, x, y, z of all points [mm]. */
  paths: readonly ArrayLike<number>[];
  colours: readonly string[];
}

/** Path of each foot, in the leg's colour. */
export function Trails({ paths, colours }: Props) {
  return (
    <group>
      {paths.map((path, leg) => (
        <Trail key={leg} path={path} colour={colours[leg] ?? "#888888"} />
      ))}
    </group>
  );
}

function Trail({ path, colour }: { path: ArrayLike<number>; colour: string }) {
  const line = useLine({ colour, width: 2, opacity: 0.75 });
  useEffect(() => setLine(line, path), [line, path]);
  return <primitive object={line} />;
}
