// Deflates a file as small as can be: node deflate.mjs FROM TO
import { readFileSync, writeFileSync } from 'node:fs'
import zopfli from '@gfx/zopfli'

const [from, to] = process.argv.slice(2)
// More iterations take a ten-thousandth off.
writeFileSync(to, await zopfli.deflateAsync(readFileSync(from), { numiterations: 3, blocksplittingmax: 0 }))
