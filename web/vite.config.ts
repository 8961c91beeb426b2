import { availableParallelism } from 'node:os'
import { defineConfig } from 'vitest/config'
import { packed } from './packed'
import { TEST, WAIT } from './test/limits'

// The built files are committed in the Rust crate that embeds them, so their names are fixed
// and nothing in them depends on the folder or on the time of the build.
export default defineConfig({
  plugins: [packed()],
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
  test: {
    include: ['test/**/*.test.ts'],
    globalSetup: 'test/samples.ts',
    // Vitest's default on two cores is one file at a time, each waiting for its browser most of the time.
    maxWorkers: Math.max(2, availableParallelism()),
    testTimeout: TEST,
    hookTimeout: TEST,
    teardownTimeout: TEST,
    expect: { poll: { timeout: WAIT } },
  },
})
