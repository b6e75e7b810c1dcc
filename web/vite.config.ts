import react from "@vitejs/plugin-react";
import { defineConfig } from "vitest/config";

// Python serves what is built, from inside its package.
export const OUT = "../src/tarsus/studio/web_dist";

export default defineConfig({
  plugins: [react()],
  base: "./",
  build: {
    outDir: OUT,
    emptyOutDir: true,
    target: "es2022",
    // A data: URL would need a hole in the page's content security policy.
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
    modulePreload: { polyfill: false },
  },
  server: {
    proxy: { "/session": { target: "ws://127.0.0.1:8600", ws: true } },
  },
  test: { environment: "node", include: ["src/**/*.test.ts"] },
});
