/** Digest of all sources of the engine. */
export function digest(): string
/** Tokens of Rust code, without comments and without items that only tests have. */
export function tokens(code: string): string[]
