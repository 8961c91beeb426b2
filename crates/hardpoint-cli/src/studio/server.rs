//! Connections: who may ask, how long and how much, and how answers go out.

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

use super::Studio;
use super::address::TokenSource;
use super::routes;

/// Number of connections at once; more of them wait until others end.
const CONNECTIONS: usize = 256;
/// The head of a request comes within this time, and the next one of a connection, too.
const HEAD: Duration = Duration::from_secs(20);
/// The body of a request does.
const BODY: Duration = Duration::from_secs(60);
/// Time limit of reading a body that is not wanted.
const PAUSE: Duration = Duration::from_secs(2);
/// Whoever takes nothing of an answer for so long is gone.
const STALLED: Duration = Duration::from_secs(60);
/// The head of a request has at most that many bytes and headers.
const HEAD_BYTES: usize = 16 << 10;
const HEADERS: usize = 64;
/// Around a text of the largest size: what JSON makes of it.
const BODY_BYTES: usize = LARGEST_FILE as usize + (1 << 20);
/// Interval of checks whether the user wants the server to end.
const LOOK: Duration = Duration::from_millis(200);
/// Time limit of current requests at the end.
const FAREWELL: Duration = Duration::from_secs(2);

/// Policy of the page: it may draw itself from its own contents, run its engine, and ask this server.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; style-src 'unsafe-inline'; \
    img-src data: blob:; font-src data:; worker-src blob:; connect-src 'self' data: blob:; base-uri 'none'; form-action 'none'; \
    frame-ancestors 'none'";

/// The body of an answer: all at once, or as it comes.
pub type Content = Either<Full<Bytes>, Channel<Bytes, Infallible>>;

/// An answer.
pub struct Answer(Box<Response<Content>>);

impl Answer {
    /// Answer with a status and a content type.
    pub fn new(status: StatusCode, kind: &'static str, content: impl Into<Bytes>) -> Self {
        Self::of(status, kind, Either::Left(Full::new(content.into())))
    }

    /// One that goes on and on.
    pub fn stream(kind: &'static str, content: Channel<Bytes, Infallible>) -> Self {
        Self::of(StatusCode::OK, kind, Either::Right(content))
    }

    fn of(status: StatusCode, kind: &'static str, content: Content) -> Self {
        let mut response = Response::new(content);
        *response.status_mut() = status;
        response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
        Self(Box::new(response))
    }

    /// A page.
    pub fn page(status: StatusCode, html: impl Into<Bytes>) -> Self {
        Self::new(status, "text/html; charset=utf-8", html)
    }

    /// A document.
    pub fn json(status: StatusCode, document: &serde_json::Value) -> Self {
        Self::new(status, "application/json", document.to_string())
    }

    /// A sentence.
    pub fn text(status: StatusCode, sentence: &str) -> Self {
        Self::new(status, "text/plain; charset=utf-8", format!("{sentence}\n"))
    }

    /// Answer to a request that cannot be done, with the reason.
    pub fn refusal(status: StatusCode, why: &str) -> Self {
        Self::json(status, &serde_json::json!({ "error": why }))
    }

    /// With one more header; one that cannot be written is left out.
    pub fn with(mut self, name: HeaderName, value: &str) -> Self {
        if let Ok(value) = HeaderValue::from_str(value) {
            self.0.headers_mut().insert(name, value);
        }
        self
    }
}

/// Serves until the user ends it.
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
    /// After a failure, of which having too many files open is the likely one, others may end first.
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
            // What goes wrong on a connection is the other side's affair.
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
            // The token stays in a cookie, and not in the address, which is seen and kept.
            let rest = request.uri().query().unwrap_or_default();
            let rest = form_urlencoded::parse(rest.as_bytes()).filter(|(key, _)| key != "token");
            let query = form_urlencoded::Serializer::new(String::new()).extend_pairs(rest).finish();
            let to = if query.is_empty() { "/".into() } else { format!("/?{query}") };
            Answer::text(StatusCode::SEE_OTHER, "The page is there.")
                .with(header::LOCATION, &to)
                .with(header::SET_COOKIE, &studio.address.cookie())
        }
        Ok(_) => {
            // What a request does, it does whole, whether somebody waits for its answer or not.
            let done = tokio::spawn(routes::answer(studio, request)).await;
            done.unwrap_or_else(|_| {
                Answer::refusal(StatusCode::INTERNAL_SERVER_ERROR, "this is a fault of the program")
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

/// The body of a request, or the answer where it is too large or does not come.
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
                let why = format!("a model has {} MiB at most", LARGEST_FILE >> 20);
                Answer::refusal(StatusCode::PAYLOAD_TOO_LARGE, &why)
            }
            Unread::TooSlow => {
                Answer::refusal(StatusCode::REQUEST_TIMEOUT, "the request does not come to its end")
            }
            Unread::Broken => Answer::refusal(StatusCode::BAD_REQUEST, "the request is broken off"),
        }
    })
}

/// Reason why there is no body.
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

/// Lets a body run out that nobody reads: many who send see no answer before they have sent all.
async fn swallow(mut body: Incoming) {
    let all = async { while let Ok(Some(Ok(_))) = timeout(PAUSE, body.frame()).await {} };
    let _ = timeout(BODY, all).await;
}

/// A connection that ends where the other side takes nothing for long.
struct Impatient {
    stream: TcpStream,
    since: Option<Pin<Box<Sleep>>>,
}

impl Impatient {
    fn new(stream: TcpStream) -> Self {
        Self { stream, since: None }
    }

    /// Result of writing, unless it has been waiting for too long.
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
