//! Bytes as text of a page: 13 bits in two characters, a thirteenth less than base64 takes.

/// Digits that end neither a script of HTML nor a string in quotation marks, as `page/report.html` and
/// `web/src/unpack.ts` know them.
const DIGITS: &[u8; 91] =
    b"0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ!#$%&'()*+,-./:;=>?@[]^_`{|}~";
/// Bits of two digits.
const PAIR: usize = 13;
/// Bits of a last single digit.
const SINGLE: usize = 6;

/// Number of characters of this number of bytes.
pub fn length(bytes: usize) -> usize {
    let (pairs, rest) = (bytes * 8 / PAIR, bytes * 8 % PAIR);
    2 * pairs + rest.div_ceil(SINGLE).min(2)
}

/// Text of bytes, the lowest bits first. It has no iterators, which take most of its time where it is not optimised.
pub fn encode(bytes: &[u8]) -> String {
    let mut text = vec![0; length(bytes.len())];
    let (mut number, mut bits, mut byte, mut at) = (0_usize, 0, 0, 0);
    while at < text.len() {
        while bits < PAIR && byte < bytes.len() {
            number |= (bytes[byte] as usize) << bits;
            bits += 8;
            byte += 1;
        }
        let pair = number & ((1 << PAIR) - 1);
        text[at] = DIGITS[pair % 91];
        if at + 1 < text.len() {
            text[at + 1] = DIGITS[pair / 91];
        }
        number >>= PAIR;
        bits = bits.saturating_sub(PAIR);
        at += 2;
    }
    String::from_utf8(text).expect("all digits are ASCII")
}

/// Bytes of a text; `None` if it has other characters.
pub fn decode(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() * PAIR / 16);
    let (mut number, mut bits) = (0, 0);
    for pair in text.as_bytes().chunks(2) {
        let mut read = 0;
        for digit in pair.iter().rev() {
            read = read * 91 + DIGITS.iter().position(|known| known == digit)?;
        }
        number |= read << bits;
        bits += if pair.len() == 2 { PAIR } else { SINGLE };
        while bits >= 8 {
            bytes.push((number & 0xff) as u8);
            number >>= 8;
            bits -= 8;
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::{decode, encode, length};

    #[test]
    fn texts_of_all_lengths_have_their_length_and_give_the_bytes_again() {
        let bytes: Vec<u8> = (0..60_u32).map(|k| (k * k * 37 + 255) as u8).collect();
        for count in 0..=bytes.len() {
            let text = encode(&bytes[..count]);
            assert_eq!(text.len(), length(count));
            assert_eq!(decode(&text).as_deref(), Some(&bytes[..count]), "{text}");
        }
        assert_eq!(decode("a\"b"), None);
    }
}
