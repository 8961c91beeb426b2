import { readFileSync } from 'node:fs'
import { expect, test } from 'vitest'
import { digest, tokens } from '../sources.mjs'

test('the engine in the page is built from the sources beside it', () => {
  const built = readFileSync(new URL('../../crates/hardpoint-report/page/engine.sources', import.meta.url), 'utf8')
  expect(built.trim(), 'run `web/build engine` and commit both files').toBe(digest())
})

test('comments, spaces and tests of the engine do not count', () => {
  const code = "fn f<'a>(x: &'a str) -> char {\n    g(\"a // b\", r#\"\"/*\"#, '\"', '\\'')\n}"
  const other = `//! About.\n/* old */${code.replace(') ->', ')\n    -> /* "a" */')}\n// End.
#[cfg(test)]\nmod tests {\n    fn g() { h("}") }\n}\n#[cfg(test)]\nuse a::{b, c};`
  expect(tokens(other)).toEqual(tokens(code))
  expect(tokens(code.replace('a // b', 'a // c'))).not.toEqual(tokens(code))
  expect(tokens(`${other}\nfn h() {}`)).not.toEqual(tokens(code))
})
