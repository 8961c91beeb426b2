//! Connections: access, limits on time and size, and responses.

use std::convert::Infallible;
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::task::{Context, Poll};
use std::time::Duration;

use http_body_util::channel::Channel;
use http_body_util::{BodyExt, Either, Full};
use hyper::body::{Body, Bytes, Incoming};
use hyper::header::{self, HeaderName, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::time::{Instant, Sleep, sleep, timeout};

use hardpoint_file::LARGEST_FILE;

use crate::session::Session;

use super::address::TokenSource;
use super::routes;
use super::state::Studio;

/// Maximum number of simultaneous connections; further ones wait.
const CONNECTIONS: usize = 256;
/// Time limit for the head of a request, and for the next request of a connection.
const HEAD: Duration = Duration::from_secs(20);
/// Time limit for the body of a request.
const BODY: Duration = Duration::from_secs(60);
/// Time limit for discarding an unused body.
const PAUSE: Duration = Duration::from_secs(2);
/// A client that accepts no data for this time is disconnected.
const STALLED: Duration = Duration::from_secs(60);
/// Maximum size of the head of a request in bytes, and its number of headers.
const HEAD_BYTES: usize = 16 << 10;
const HEADERS: usize = 64;
/// Maximum size of a body: a text of the largest size, escaped as JSON.
const BODY_BYTES: usize = LARGEST_FILE as usize + (1 << 20);
/// Interval of checks whether the user wants the server to end.
const LOOK: Duration = Duration::from_millis(200);
/// Time limit for pending requests at shutdown.
const FAREWELL: Duration = Duration::from_secs(2);

/// Content security policy: the page may use its own contents, run its engine, and contact this server.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; style-src 'unsafe-inline'; \
    img-src data: blob:; font-src data:; worker-src blob:; connect-src 'self' data: blob:; base-uri 'none'; form-action 'none'; \
    frame-ancestors 'none'";

/// Body of an answer: complete, or a stream.
pub type Content = Either<Full<Bytes>, Channel<Bytes, Infallible>>;

/// An answer.
pub struct Answer(Box<Response<Content>>);

impl Answer {
    /// Answer with a status and a content type.
    pub fn new(status: StatusCode, kind: &'static str, content: impl Into<Bytes>) -> Self {
        Self::of(status, kind, Either::Left(Full::new(content.into())))
    }

    /// Answer with a stream of events.
    pub fn stream(kind: &'static str, content: Channel<Bytes, Infallible>) -> Self {
        Self::of(StatusCode::OK, kind, Either::Right(content))
    }

    fn of(status: StatusCode, kind: &'static str, content: Content) -> Self {
        let mut response = Response::new(content);
        *response.status_mut() = status;
        response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
        Self(Box::new(response))
    }

    /// Answer with a page.
    pub fn page(status: StatusCode, html: impl Into<Bytes>) -> Self {
        Self::new(status, "text/html; charset=utf-8", html)
    }

    /// Answer with a JSON document.
    pub fn json(status: StatusCode, document: &serde_json::Value) -> Self {
        Self::new(status, "application/json", document.to_string())
    }

    /// Answer with plain text.
    pub fn text(status: StatusCode, sentence: &str) -> Self {
        Self::new(status, "text/plain; charset=utf-8", format!("{sentence}\n"))
    }

    /// Answer to a request that cannot be done, with the reason.
    pub fn refusal(status: StatusCode, why: &str) -> Self {
        Self::json(status, &serde_json::json!({ "error": why }))
    }

    /// Adds a header; an invalid one is ignored.
    pub fn with(mut self, name: HeaderName, value: &str) -> Self {
        if let Ok(value) = HeaderValue::from_str(value) {
            self.0.headers_mut().insert(name, value);
        }
        self
    }
}

/// Serves until the user stops it.
pub fn serve(listener: std::net::TcpListener, studio: &Arc<Studio>, session: &Session) -> io::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_io()
        .enable_time()
        .max_blocking_threads(64)
        .build()?;
    let accepting = Arc::clone(studio);
    runtime.block_on(async {
        listener.set_nonblocking(true)?;
        let listener = TcpListener::from_std(listener)?;
        tokio::spawn(accept(listener, accepting));
        while !session.interrupted() {
            sleep(LOOK).await;
        }
        io::Result::Ok(())
    })?;
    studio.ending.store(true, Ordering::SeqCst);
    studio.studies.cancel_all();
    runtime.shutdown_timeout(FAREWELL);
    Ok(())
}

async fn accept(listener: TcpListener, studio: Arc<Studio>) {
    /// Waits after a failure, most likely too many open files, so that other connections can end.
    const AGAIN: Duration = Duration::from_millis(100);
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    loop {
        let Ok(place) = Arc::clone(&places).acquire_owned().await else { return };
        let Ok((stream, _)) = listener.accept().await else {
            sleep(AGAIN).await;
            continue;
        };
        let studio = Arc::clone(&studio);
        tokio::spawn(async move {
            let answer = |request| answer(Arc::clone(&studio), request);
            // Errors of a connection concern the client only.
            let _ = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(HEAD)
                .max_buf_size(HEAD_BYTES)
                .max_headers(HEADERS)
                .serve_connection(TokioIo::new(Impatient::new(stream)), service_fn(answer))
                .await;
            drop(place);
        });
    }
}

async fn answer(studio: Arc<Studio>, request: Request<Incoming>) -> Result<Response<Content>, Infallible> {
    let shown = studio.address.lets_in(request.method(), request.uri(), request.headers());
    let answer = match shown {
        Err(why) => {
            tokio::spawn(swallow(request.into_body()));
            Answer::text(StatusCode::FORBIDDEN, why)
        }
        Ok(TokenSource::InAddress) if request.method() == Method::GET && request.uri().path() == "/" => {
            // The token moves to a cookie, because the address is visible and stored in the history.
            let rest = request.uri().query().unwrap_or_default();
            let rest = form_urlencoded::parse(rest.as_bytes()).filter(|(key, _)| key != "token");
            let query = form_urlencoded::Serializer::new(String::new()).extend_pairs(rest).finish();
            let to = if query.is_empty() { "/".into() } else { format!("/?{query}") };
            Answer::text(StatusCode::SEE_OTHER, "The page is there.")
                .with(header::LOCATION, &to)
                .with(header::SET_COOKIE, &studio.address.cookie())
        }
        Ok(_) => {
            // A request is completed even if the client no longer waits for the answer.
            let done = tokio::spawn(routes::answer(studio, request)).await;
            done.unwrap_or_else(|_| {
                Answer::refusal(StatusCode::INTERNAL_SERVER_ERROR, "internal error of the program")
            })
        }
    };
    let mut response = *answer.0;
    let headers = response.headers_mut();
    for (name, value) in [
        (header::CACHE_CONTROL, "no-store"),
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "same-origin"),
        (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
        (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    Ok(response)
}

/// Reads the body of a request; the error is the answer if it is too large or incomplete.
pub async fn body(request: Request<Incoming>) -> Result<Vec<u8>, Answer> {
    let mut body = request.into_body();
    let all = match body.size_hint().lower() > BODY_BYTES as u64 {
        true => Err(Unread::TooLarge),
        false => timeout(BODY, all_of(&mut body)).await.unwrap_or(Err(Unread::TooSlow)),
    };
    all.map_err(|why| {
        tokio::spawn(swallow(body));
        match why {
            Unread::TooLarge => {
                let why = format!("the maximum size of a model is {} MiB", LARGEST_FILE >> 20);
                Answer::refusal(StatusCode::PAYLOAD_TOO_LARGE, &why)
            }
            Unread::TooSlow => {
                Answer::refusal(StatusCode::REQUEST_TIMEOUT, "the request is incomplete: time limit exceeded")
            }
            Unread::Broken => Answer::refusal(
                StatusCode::BAD_REQUEST,
                "the connection was closed before the end of the request",
            ),
        }
    })
}

/// Reason for a missing body.
enum Unread {
    TooLarge,
    TooSlow,
    Broken,
}

async fn all_of(body: &mut Incoming) -> Result<Vec<u8>, Unread> {
    let mut all = Vec::new();
    while let Some(frame) = body.frame().await {
        let Ok(data) = frame.map_err(|_| Unread::Broken)?.into_data() else { continue };
        if all.len() + data.len() > BODY_BYTES {
            return Err(Unread::TooLarge);
        }
        all.extend_from_slice(&data);
    }
    Ok(all)
}

/// Discards an unused body: many clients read no answer before they have sent everything.
async fn swallow(mut body: Incoming) {
    let all = async { while let Ok(Some(Ok(_))) = timeout(PAUSE, body.frame()).await {} };
    let _ = timeout(BODY, all).await;
}

/// A connection that is closed if the client accepts no data for too long.
struct Impatient {
    stream: TcpStream,
    since: Option<Pin<Box<Sleep>>>,
}

impl Impatient {
    fn new(stream: TcpStream) -> Self {
        Self { stream, since: None }
    }

    /// Result of writing, or an error after the time limit.
    fn waited<X>(&mut self, written: Poll<io::Result<X>>, context: &mut Context<'_>) -> Poll<io::Result<X>> {
        if written.is_ready() {
            self.since = None;
            return written;
        }
        let since =
            self.since.get_or_insert_with(|| Box::pin(tokio::time::sleep_until(Instant::now() + STALLED)));
        since.as_mut().poll(context).map(|()| Err(io::ErrorKind::TimedOut.into()))
    }
}

impl AsyncRead for Impatient {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, into)
    }
}

impl AsyncWrite for Impatient {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.waited(written, context)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        let flushed = Pin::new(&mut self.stream).poll_flush(context);
        self.waited(flushed, context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}
