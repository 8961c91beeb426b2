//! Access control: requests need the token, must come from this machine, and from a page of this server.

use hyper::header::{self, HeaderMap, HeaderValue};
use hyper::{Method, Uri};

/// Name of the header that carries the token.
pub const HEADER: &str = "x-hardpoint-token";
/// Minimum length of a token that the user chooses.
pub const SHORTEST_TOKEN: usize = 16;

/// Address of a server, and the conditions for its requests.
pub struct Address {
    port: u16,
    token: String,
    /// Host names that requests may use.
    hosts: Vec<String>,
}

/// Source of a request's token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenSource {
    /// The address, as printed on the terminal.
    InAddress,
    /// A header or cookie, as sent by a page of the server.
    ByPage,
}

impl Address {
    /// Access control for this port and token.
    pub fn new(port: u16, token: String) -> Self {
        let mut hosts = vec![format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        if port == 80 {
            hosts.extend(["127.0.0.1".into(), "localhost".into()]);
        }
        Self { port, token, hosts }
    }

    /// Address to open in the browser.
    pub fn to_open(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    /// The token.
    pub fn token(&self) -> &str {
        &self.token
    }

    /// Cookie of the page at that address; browsers distinguish cookies of different ports by their names only.
    pub fn cookie(&self) -> String {
        format!("{}={}; Path=/; HttpOnly; SameSite=Strict", self.cookie_name(), self.token)
    }

    fn cookie_name(&self) -> String {
        format!("hardpoint-{}", self.port)
    }

    /// Checks a request and returns the source of its token.
    ///
    /// # Errors
    /// The reason as a sentence for the client.
    pub fn lets_in(
        &self,
        method: &Method,
        uri: &Uri,
        headers: &HeaderMap,
    ) -> Result<TokenSource, &'static str> {
        const HOST: &str = "This server answers to 127.0.0.1 and localhost only.";
        const FOREIGN: &str = "This server answers to its own pages only.";
        const TOKEN: &str =
            "This needs the token of the address that `hardpoint studio` has printed: open that address.";
        let is_ours = |host: &str| self.hosts.iter().any(|h| h.eq_ignore_ascii_case(host));
        // An absolute address in the request takes precedence over the host header; both are checked.
        let named = one(headers, header::HOST).is_some_and(is_ours);
        if !named || !uri.authority().is_none_or(|a| is_ours(a.as_str())) {
            return Err(HOST);
        }
        let is_own_origin = |value: &HeaderValue| {
            value.to_str().ok().and_then(|v| v.strip_prefix("http://")).is_some_and(is_ours)
        };
        if !headers.get_all(header::ORIGIN).iter().all(is_own_origin) {
            return Err(FOREIGN);
        }
        let in_address = uri.query().is_some_and(|q| {
            form_urlencoded::parse(q.as_bytes()).any(|(key, value)| key == "token" && self.is_token(&value))
        });
        // Browsers report the site of a request even without an origin. Following a link with the token is allowed.
        let site = headers.get_all("sec-fetch-site").iter().all(|v| v == "same-origin" || v == "none");
        let follows_link = method == Method::GET && one(headers, "sec-fetch-mode") == Some("navigate");
        if !(site || in_address && follows_link) {
            return Err(FOREIGN);
        }
        let in_header = one(headers, HEADER).is_some_and(|token| self.is_token(token));
        if in_header || self.is_in_cookie(headers) {
            Ok(if in_address { TokenSource::InAddress } else { TokenSource::ByPage })
        } else if in_address {
            Ok(TokenSource::InAddress)
        } else {
            Err(TOKEN)
        }
    }

    fn is_in_cookie(&self, headers: &HeaderMap) -> bool {
        let name = self.cookie_name();
        let cookies = headers.get_all(header::COOKIE).iter().filter_map(|v| v.to_str().ok());
        let mut pairs = cookies.flat_map(|v| v.split(';')).filter_map(|pair| pair.trim().split_once('='));
        pairs.any(|(key, value)| key == name && self.is_token(value))
    }

    /// Compares in constant time.
    fn is_token(&self, token: &str) -> bool {
        let pairs = token.bytes().zip(self.token.bytes());
        token.len() == self.token.len() && pairs.fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
    }
}

/// Value of a header that occurs exactly once, as text.
fn one(headers: &HeaderMap, name: impl header::AsHeaderName) -> Option<&str> {
    let mut values = headers.get_all(name).iter();
    values.next().filter(|_| values.next().is_none())?.to_str().ok()
}

/// A random token.
pub fn random_token() -> Result<String, getrandom::Error> {
    let mut bytes = [0_u8; 16];
    getrandom::fill(&mut bytes)?;
    Ok(bytes.iter().map(|b| format!("{b:02x}")).collect())
}

/// Parses a token given by the user.
pub fn given_token(text: &str) -> Result<String, String> {
    let is_plain = text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_');
    if is_plain && text.len() >= SHORTEST_TOKEN {
        Ok(text.into())
    } else {
        Err(format!("a token needs at least {SHORTEST_TOKEN} letters, digits, `-` and `_`"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOKEN: &str = "0123456789abcdef";

    fn asked(uri: &str, headers: &[(&str, &str)]) -> Result<TokenSource, &'static str> {
        let mut all = HeaderMap::new();
        for (name, value) in headers {
            all.append(header::HeaderName::from_bytes(name.as_bytes()).unwrap(), value.parse().unwrap());
        }
        Address::new(4000, TOKEN.into()).lets_in(&Method::GET, &uri.parse().unwrap(), &all)
    }

    #[test]
    fn only_who_has_the_token_passes_and_only_from_here() {
        let host = ("host", "127.0.0.1:4000");
        let cookie = ("cookie", "a=b; hardpoint-4000=0123456789abcdef");
        let with_token = format!("/?token={TOKEN}");
        assert_eq!(asked(&with_token, &[host]), Ok(TokenSource::InAddress));
        assert_eq!(asked("/", &[("host", "LOCALHOST:4000"), cookie]), Ok(TokenSource::ByPage));
        assert_eq!(
            asked("/", &[host, (HEADER, TOKEN), ("origin", "http://localhost:4000")]),
            Ok(TokenSource::ByPage)
        );
        assert_eq!(asked("/", &[host, cookie, ("sec-fetch-site", "same-origin")]), Ok(TokenSource::ByPage));
        let link = [("sec-fetch-site", "cross-site"), ("sec-fetch-mode", "navigate")];
        assert!(asked(&with_token, &[host, link[0], link[1]]).is_ok());

        let refused: [(&str, &[(&str, &str)]); 15] = [
            ("/", &[host]),
            ("/?token=", &[host]),
            ("/?token=0123456789abcdeg", &[host]),
            ("/?token=0123456789abcdef0", &[host]),
            ("/", &[host, ("cookie", "hardpoint-4001=0123456789abcdef")]),
            (&with_token, &[]),
            (&with_token, &[host, host]),
            (&with_token, &[("host", "127.0.0.1")]),
            (&with_token, &[("host", "127.0.0.1:4001")]),
            (&with_token, &[("host", "example.org:4000")]),
            (&with_token, &[host, ("origin", "http://example.org")]),
            (&with_token, &[host, ("origin", "null")]),
            ("/", &[host, cookie, ("origin", "http://127.0.0.1:4001")]),
            ("/", &[host, cookie, link[0], link[1]]),
            (&with_token, &[host, link[0]]),
        ];
        for (uri, headers) in refused {
            assert!(asked(uri, headers).is_err(), "{uri} {headers:?}");
        }
        assert!(asked(&format!("http://example.org/?token={TOKEN}"), &[host]).is_err());
    }

    #[test]
    fn tokens_are_long_and_plain() {
        assert_ne!(random_token().unwrap(), random_token().unwrap());
        assert!(given_token(&random_token().unwrap()).is_ok());
        assert!(given_token("short").is_err() && given_token("0123456789abcdef;").is_err());
    }
}
