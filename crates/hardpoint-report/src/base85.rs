//! Bytes as text of a page: four bytes in five characters, a sixteenth less than base64 takes.

/// Digits that mean nothing to HTML, as `page/report.html` and `web/src/unpack.ts` know them.
const DIGITS: &[u8; 85] =
    b"0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?,;_()[]{}@%$#";

/// Number of characters of this number of bytes. A last incomplete group takes one character more than bytes.
pub fn length(bytes: usize) -> usize {
    bytes + bytes.div_ceil(4)
}

/// Text of bytes.
pub fn encode(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(length(bytes.len()));
    for chunk in bytes.chunks(4) {
        let mut four = [0; 4];
        four[..chunk.len()].copy_from_slice(chunk);
        let number = u32::from_be_bytes(four);
        for place in 0..=chunk.len() as u32 {
            text.push(char::from(DIGITS[(number / 85_u32.pow(4 - place) % 85) as usize]));
        }
    }
    text
}

/// Bytes of a text; `None` if it has other characters, or groups that are no four bytes.
pub fn decode(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 5 * 4 + 3);
    for group in text.as_bytes().chunks(5) {
        // The last characters count as if the greatest digit followed them.
        let mut number = 0_u64;
        for place in 0..5 {
            let digit = group.get(place).map_or(Some(84), |c| DIGITS.iter().position(|digit| digit == c))?;
            number = number * 85 + digit as u64;
        }
        bytes.extend_from_slice(&u32::try_from(number).ok()?.to_be_bytes()[..group.len() - 1]);
    }
    Some(bytes)
}
