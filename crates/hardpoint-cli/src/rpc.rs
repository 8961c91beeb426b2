//! JSON-RPC 2.0 over streams: messages in two formats, and answers to invalid ones. Agents and editors use it.

use std::io::{self, BufRead, Read, Write};
use std::sync::{Arc, Mutex, PoisonError};

use serde_json::{Value, json};

/// Maximum size of a message in bytes.
const LARGEST_MESSAGE: usize = 64 << 20;
/// Maximum length of a line of a header, and number of lines.
const LONGEST_HEADER: u64 = 4096;
const MOST_HEADERS: usize = 32;

/// Separation of messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessageFormat {
    /// One message on each line.
    Lines,
    /// Headers with the length of each message, as in the language server protocol.
    Headers,
}

/// Error of a request.
#[derive(Clone, Debug, PartialEq)]
pub struct RpcError {
    /// Code of JSON-RPC, or of the protocol above.
    pub code: i64,
    /// Message.
    pub message: String,
    /// Further facts.
    pub data: Option<Value>,
}

impl RpcError {
    /// The text is not JSON.
    pub const PARSE: i64 = -32700;
    /// The JSON is not a request.
    pub const INVALID_REQUEST: i64 = -32600;
    /// There is no such method.
    pub const METHOD_NOT_FOUND: i64 = -32601;
    /// The method does not accept these parameters.
    pub const INVALID_PARAMS: i64 = -32602;
    /// A fault of the program.
    pub const INTERNAL: i64 = -32603;

    /// Error with this code.
    pub fn new(code: i64, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), data: None }
    }

    /// Error of a method that does not exist.
    pub fn unknown_method(method: &str) -> Self {
        Self::new(Self::METHOD_NOT_FOUND, format!("there is no method `{method}`"))
    }

    /// Error of parameters.
    pub fn invalid(message: impl Into<String>) -> Self {
        Self::new(Self::INVALID_PARAMS, message)
    }
}

/// A message of the other side.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// A request, which must be answered.
    Request {
        /// Number or text that the answer repeats.
        id: Value,
        /// Method.
        method: String,
        /// Parameters; `null` without any.
        params: Value,
    },
    /// A request without an answer.
    Notification {
        /// Method.
        method: String,
        /// Parameters; `null` without any.
        params: Value,
    },
    /// An answer, to a request that this program does not make.
    Answer,
    /// An invalid message, with the answer to it.
    Invalid {
        /// The `id` of the message, if it has a valid one.
        id: Value,
        /// Error.
        error: RpcError,
    },
}

impl Message {
    /// Reads the text of a message.
    fn of(text: &[u8]) -> Self {
        let invalid = |id: Value, why: &str| Self::Invalid {
            id,
            error: RpcError::new(RpcError::INVALID_REQUEST, why.to_owned()),
        };
        let mut message = match serde_json::from_slice(text) {
            Ok(Value::Object(message)) => message,
            Ok(Value::Array(_)) => return invalid(Value::Null, "batches of requests are not supported"),
            Ok(_) => return invalid(Value::Null, "a message is an object"),
            Err(error) => {
                let error = RpcError::new(RpcError::PARSE, format!("the message is not JSON: {error}"));
                return Self::Invalid { id: Value::Null, error };
            }
        };
        let id = message.remove("id");
        let is_valid = |id: &Value| id.is_string() || id.is_number();
        let known = id.clone().filter(is_valid).unwrap_or(Value::Null);
        if message.get("jsonrpc").and_then(Value::as_str) != Some("2.0") {
            return invalid(known, "`jsonrpc` must be \"2.0\"");
        }
        let Some(method) = message.remove("method") else {
            let is_answer = message.contains_key("result") || message.contains_key("error");
            return if is_answer { Self::Answer } else { invalid(known, "the message has no `method`") };
        };
        let Value::String(method) = method else {
            return invalid(known, "`method` must be a text");
        };
        let params = message.remove("params").unwrap_or(Value::Null);
        if !(params.is_object() || params.is_array() || params.is_null()) {
            return invalid(known, "`params` must be an object or a list");
        }
        match id {
            None => Self::Notification { method, params },
            Some(id) if is_valid(&id) => Self::Request { id, method, params },
            Some(_) => invalid(Value::Null, "`id` must be a number or a text"),
        }
    }
}

/// Reads the next message; `None` at the end of the stream.
///
/// # Errors
/// Fails if the stream cannot be read, or its headers are invalid, so that the next message cannot be found.
pub fn read_message(input: &mut impl BufRead, format: MessageFormat) -> io::Result<Option<Message>> {
    match format {
        MessageFormat::Lines => loop {
            let mut line = Vec::new();
            let limit = LARGEST_MESSAGE as u64 + 1;
            if input.by_ref().take(limit).read_until(b'\n', &mut line)? == 0 {
                return Ok(None);
            }
            if line.len() > LARGEST_MESSAGE {
                return Err(invalid_data("a message is too large"));
            }
            if !line.trim_ascii().is_empty() {
                return Ok(Some(Message::of(line.trim_ascii())));
            }
        },
        MessageFormat::Headers => {
            let Some(length) = content_length(input)? else { return Ok(None) };
            let mut text = vec![0; length];
            input.read_exact(&mut text)?;
            Ok(Some(Message::of(&text)))
        }
    }
}

/// Length of the next message from its headers; `None` at the end of the stream.
fn content_length(input: &mut impl BufRead) -> io::Result<Option<usize>> {
    let mut length = None;
    for count in 0..MOST_HEADERS {
        let mut line = Vec::new();
        if input.by_ref().take(LONGEST_HEADER).read_until(b'\n', &mut line)? == 0 {
            return match count {
                0 => Ok(None),
                _ => Err(invalid_data("the stream ends within the headers of a message")),
            };
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        if line.is_empty() {
            match length {
                Some(length) if length <= LARGEST_MESSAGE => return Ok(Some(length)),
                Some(_) => return Err(invalid_data("a message is too large")),
                // Blank lines between messages.
                None if count == 0 => continue,
                None => return Err(invalid_data("a message has no `Content-Length`")),
            }
        }
        let Some((name, value)) = line.split_once(':') else {
            return Err(invalid_data("a header has no colon"));
        };
        if name.trim().eq_ignore_ascii_case("content-length") {
            let value = value.trim().parse().map_err(|_| invalid_data("`Content-Length` is not a number"))?;
            length = Some(value);
        }
    }
    Err(invalid_data("a message has too many headers"))
}

fn invalid_data(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, why)
}

/// Stream of messages to the other side, for several threads.
#[derive(Clone)]
pub struct Output {
    out: Arc<Mutex<Box<dyn Write + Send>>>,
    format: MessageFormat,
}

impl Output {
    /// Messages to a stream.
    pub fn new(out: impl Write + Send + 'static, format: MessageFormat) -> Self {
        Self { out: Arc::new(Mutex::new(Box::new(out))), format }
    }

    /// Sends a message. A closed stream is noticed when its other side ends.
    fn send(&self, message: &Value) {
        let text = message.to_string();
        let framed = match self.format {
            MessageFormat::Lines => format!("{text}\n"),
            MessageFormat::Headers => format!("Content-Length: {}\r\n\r\n{text}", text.len()),
        };
        let mut out = self.out.lock().unwrap_or_else(PoisonError::into_inner);
        if let Err(error) = out.write_all(framed.as_bytes()).and_then(|()| out.flush()) {
            crate::text::note_failure(error);
        }
    }

    /// Answers a request.
    pub fn answer(&self, id: &Value, result: Result<Value, RpcError>) {
        self.send(&match result {
            Ok(result) => json!({ "jsonrpc": "2.0", "id": id, "result": result }),
            Err(RpcError { code, message, data }) => {
                let mut error = json!({ "code": code, "message": message });
                if let Some(data) = data {
                    error["data"] = data;
                }
                json!({ "jsonrpc": "2.0", "id": id, "error": error })
            }
        });
    }

    /// Sends a notification.
    pub fn notify(&self, method: &str, params: &Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }
}

/// Parameters as a type.
///
/// # Errors
/// Fails if they have other keys or types.
pub fn params_of<T: serde::de::DeserializeOwned>(params: Value) -> Result<T, RpcError> {
    T::deserialize(&params).map_err(|error| {
        let named =
            invalid_parameter::<T>(&params).map_or("parameters".into(), |key| format!("parameter `{key}`"));
        let count = |words: String, kind: &str| {
            words.replace(&format!("expected {kind}"), "expected a whole number from 0")
        };
        let why = ["u8", "u16", "u32", "u64", "usize"].into_iter().fold(error.to_string(), count);
        RpcError::invalid(format!("invalid {named}: {why}"))
    })
}

/// The parameter without which the others are valid; `None` if there is none, or several are invalid.
fn invalid_parameter<T: serde::de::DeserializeOwned>(params: &Value) -> Option<&str> {
    let given = params.as_object()?;
    let is_valid_without = |key: &&String| {
        let mut others = given.clone();
        others.remove(*key);
        T::deserialize(Value::Object(others)).is_ok()
    };
    given.keys().find(is_valid_without).map(String::as_str)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_invalid_parameter_is_named() {
        #[derive(Debug, serde::Deserialize)]
        struct Asked {
            #[allow(dead_code)]
            samples: Option<u32>,
        }
        let error = params_of::<Asked>(json!({ "path": "a.toml", "samples": -4 })).unwrap_err();
        let wanted =
            "invalid parameter `samples`: invalid value: integer `-4`, expected a whole number from 0";
        assert_eq!(error.message, wanted);
    }

    fn all(text: &str, format: MessageFormat) -> Vec<io::Result<Message>> {
        let mut input = text.as_bytes();
        let mut found = Vec::new();
        loop {
            match read_message(&mut input, format) {
                Ok(None) => return found,
                Ok(Some(message)) => found.push(Ok(message)),
                Err(error) => {
                    found.push(Err(error));
                    return found;
                }
            }
        }
    }

    fn code(message: &io::Result<Message>) -> (Value, i64) {
        match message {
            Ok(Message::Invalid { id, error }) => (id.clone(), error.code),
            other => panic!("{other:?} is valid"),
        }
    }

    #[test]
    fn lines_are_requests_notifications_and_answers() {
        let text = "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"a\",\"params\":{\"x\":1}}\n\n\
                    {\"jsonrpc\":\"2.0\",\"method\":\"b\"}\r\n{\"jsonrpc\":\"2.0\",\"id\":1,\"result\":{}}";
        let found: Vec<Message> = all(text, MessageFormat::Lines).into_iter().map(Result::unwrap).collect();
        assert_eq!(
            found,
            [
                Message::Request { id: 1.into(), method: "a".into(), params: json!({ "x": 1 }) },
                Message::Notification { method: "b".into(), params: Value::Null },
                Message::Answer,
            ]
        );
    }

    #[test]
    fn invalid_messages_have_the_codes_of_the_standard() {
        let lines = [
            ("{\"jsonrpc\": ", (Value::Null, RpcError::PARSE)),
            ("[]", (Value::Null, RpcError::INVALID_REQUEST)),
            ("3", (Value::Null, RpcError::INVALID_REQUEST)),
            ("{\"id\": 7, \"method\": \"a\"}", (7.into(), RpcError::INVALID_REQUEST)),
            ("{\"jsonrpc\": \"2.0\", \"id\": 7}", (7.into(), RpcError::INVALID_REQUEST)),
            ("{\"jsonrpc\": \"2.0\", \"id\": \"k\", \"method\": 1}", ("k".into(), RpcError::INVALID_REQUEST)),
            (
                "{\"jsonrpc\": \"2.0\", \"id\": null, \"method\": \"a\"}",
                (Value::Null, RpcError::INVALID_REQUEST),
            ),
            (
                "{\"jsonrpc\": \"2.0\", \"id\": 8, \"method\": \"a\", \"params\": 1}",
                (8.into(), RpcError::INVALID_REQUEST),
            ),
        ];
        for (line, expected) in lines {
            let found = all(line, MessageFormat::Lines);
            assert_eq!(code(&found[0]), expected, "{line}");
        }
        // The next line is read after an invalid one.
        let found = all("nonsense\n{\"jsonrpc\":\"2.0\",\"method\":\"b\"}\n", MessageFormat::Lines);
        assert!(matches!(&found[1], Ok(Message::Notification { method, .. }) if method == "b"));
    }

    #[test]
    fn headers_count_bytes_and_other_headers_are_ignored() {
        let body = "{\"jsonrpc\":\"2.0\",\"method\":\"straße\"}";
        let framed =
            format!("content-length: {}\r\nContent-Type: x; charset=utf-8\r\n\r\n{body}", body.len());
        let found = all(&framed.repeat(2), MessageFormat::Headers);
        assert_eq!(found.len(), 2);
        assert!(
            found.iter().all(|m| matches!(m, Ok(Message::Notification { method, .. }) if method == "straße"))
        );
    }

    #[test]
    fn broken_headers_end_the_stream() {
        for text in [
            "Content-Length: x\r\n\r\n",
            "Content-Length 5\r\n\r\n",
            "Content-Type: x\r\n\r\n{}",
            "Content-Length: 5\r\n",
            "Content-Length: 5\r\n\r\n{}",
            "Content-Length: 99999999999\r\n\r\n",
        ] {
            assert!(all(text, MessageFormat::Headers)[0].is_err(), "{text:?}");
        }
    }

    #[test]
    fn messages_are_framed_as_they_are_read() {
        #[derive(Clone, Default)]
        struct Shared(Arc<Mutex<Vec<u8>>>);
        impl Write for Shared {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                self.0.lock().unwrap().extend(bytes);
                Ok(bytes.len())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        for format in [MessageFormat::Lines, MessageFormat::Headers] {
            let shared = Shared::default();
            let output = Output::new(shared.clone(), format);
            output.notify("näch\nste", &json!({ "x": "a\nb" }));
            output.answer(&4.into(), Err(RpcError::unknown_method("z")));
            let text = String::from_utf8(shared.0.lock().unwrap().clone()).unwrap();
            let found = all(&text, format);
            assert_eq!(found.len(), 2, "{text}");
            assert!(
                matches!(&found[0], Ok(Message::Notification { method, .. }) if method == "näch\nste"),
                "{text}"
            );
            assert!(matches!(&found[1], Ok(Message::Answer)), "{text}");
        }
    }
}
