import react from "@vitejs/plugin-react";
import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

import { OUT } from "./vite.config";

// The player is one file that plays a walk offline: everything inline, nothing to ask for.
export default defineConfig({
  plugins: [react(), viteSingleFile({ removeViteModuleLoader: true })],
  base: "./",
  build: {
    outDir: OUT,
    emptyOutDir: false,
    target: "es2022",
    chunkSizeWarningLimit: 3000,
    rollupOptions: { input: "player.html" },
  },
});
