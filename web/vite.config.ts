import { defineConfig } from 'vitest/config'

// The built files are committed in the Rust crate that embeds them, so their names are fixed
// and nothing in them depends on the folder or on the time of the build.
export default defineConfig({
  build: {
    outDir: '../crates/hardpoint-report/page',
    emptyOutDir: false,
    target: 'es2022',
    modulePreload: false,
    chunkSizeWarningLimit: 800,
    rolldownOptions: {
      input: 'src/main.ts',
      output: { entryFileNames: 'app.js', assetFileNames: 'app[extname]', codeSplitting: false },
    },
  },
  test: { include: ['test/**/*.test.ts'], testTimeout: 60_000, hookTimeout: 300_000 },
})
