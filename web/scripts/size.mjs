// How much a visitor's browser fetches at first, compressed: must stay under 1.5 MB.
import { readdirSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";

const OUT = new URL("../../src/tarsus/studio/web_dist/", import.meta.url).pathname;
const MOST = 1_500_000;

function files(folder) {
  return readdirSync(folder).flatMap((name) => {
    const path = join(folder, name);
    return statSync(path).isDirectory() ? files(path) : [path];
  });
}

// The player is a page of its own, that no visitor of the studio fetches.
const fetched = files(OUT).filter((path) => !path.endsWith("player.html") && !path.endsWith(".map"));
const sizes = fetched.map((path) => [path.slice(OUT.length), gzipSync(readFileSync(path)).length]);
const total = sizes.reduce((sum, [, size]) => sum + size, 0);
for (const [name, size] of sizes) console.log(`${String(size).padStart(9)}  ${name}`);
console.log(`${String(total).padStart(9)}  in all, of at most ${MOST}`);
if (total > MOST) process.exit(1);
