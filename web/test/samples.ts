import { type StdioOptions, execFileSync } from 'node:child_process'
import { mkdtempSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import type { TestProject } from 'vitest/node'

declare module 'vitest' {
  export interface ProvidedContext {
    /** Reports of the sample mechanism: of its whole motion, and of one that stops. */
    samples: { whole: string; partial: string }
  }
}

/**
 * Builds and writes the sample reports once, before any test. A global set-up has no time limit, so that compiling may
 * take as long as the machine needs.
 */
export default function setup(project: TestProject): () => void {
  const folder = mkdtempSync(join(tmpdir(), 'hardpoint-page-'))
  const samples = { whole: join(folder, 'sample.html'), partial: join(folder, 'partial.html') }
  project.provide('samples', samples)
  // With a report to test in place of the sample there is nothing to build.
  if (!process.env.HARDPOINT_REPORT) {
    const program = build()
    execFileSync(program, [samples.whole])
    execFileSync(program, [samples.partial, '--partial'])
  }
  return () => rmSync(folder, { recursive: true })
}

/** The built program: with the whole workspace, as `cargo test` builds it, so that after that there is nothing left to compile. */
function build(): string {
  const command = ['build', '--workspace', '--example', 'sample_page', '--message-format', 'json']
  const stdio: StdioOptions = ['ignore', 'pipe', 'inherit']
  const options = { cwd: join(import.meta.dirname, '../..'), maxBuffer: Infinity, stdio }
  const messages = execFileSync('cargo', command, options).toString().trim().split('\n')
  const programs = messages.map((line) => JSON.parse(line).executable as string | null | undefined)
  const program = programs.find((name) => name)
  if (!program) throw new Error('cargo built no sample_page')
  return program
}
