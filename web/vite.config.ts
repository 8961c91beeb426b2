import { defineConfig } from 'vitest/config'
import { packed } from './packed'

/**
 * Milliseconds after which a test counts as hung: a quarter of an hour, where the slowest takes seconds. No result may depend on
 * how fast or how busy the machine is, so a limit is there only so that a hang ends, and soon enough for the rest to be told.
 */
const HANG = 900_000

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
    testTimeout: HANG,
    hookTimeout: HANG,
    teardownTimeout: HANG,
    expect: { poll: { timeout: HANG } },
  },
})
