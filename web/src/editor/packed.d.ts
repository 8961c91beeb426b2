/** A part of the page as text, which `packed.ts` makes. */
declare module '*?packed' {
  const base64: string
  export default base64
}
