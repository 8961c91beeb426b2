//! Start of a server, from the options of the command.

use std::io::IsTerminal;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::address::{Address, random_token};
use super::folder::Models;
use super::pages::Pages;
use super::server::serve;
use super::state::Studio;
use super::studies::Studies;
use crate::args;
use crate::outcome::Outcome;
use crate::session::Session;
use crate::text;

/// Serves until the user stops it.
pub fn run(options: &args::Studio) -> Outcome {
    let session = Session::begin(false);
    session.end(studio_in(&session, options))
}

fn studio_in(session: &Session, options: &args::Studio) -> Result<Outcome, Outcome> {
    let (path, opened) = match &options.model {
        Some(model) => of_model(session, model)?,
        None => (of_gallery(), None),
    };
    let failed = |what: String, why: &dyn std::fmt::Display| {
        session.not_served(&what, &why.to_string(), "see `docs/studio.md`")
    };
    let models = Models::of(&path)
        .map_err(|e| failed(format!("the folder `{}` cannot be read", path.display()), &e))?;
    if let Some(name) = opened.as_ref().filter(|name| !models.is_name(name)) {
        let why = format!(
            "`{name}` is not a model file: its name must end with `.toml`, and it must be in the folder itself"
        );
        return Err(session.misunderstood(&why));
    }
    let random = || random_token().map_err(|e| failed("the system provides no random numbers".into(), &e));
    let token = options.token.clone().map_or_else(random, Ok)?;
    let listening = TcpListener::bind((Ipv4Addr::LOCALHOST, options.port))
        .and_then(|listener| Ok((listener.local_addr()?.port(), listener)));
    let (port, listener) = listening.map_err(|e| {
        let what = format!("cannot listen on port {} of this machine", options.port);
        session.not_served(
            &what,
            &e.to_string(),
            "select another port with `--port`, or stop the program that uses this one",
        )
    })?;
    let address = Address::new(port, token);
    let to_open = address.to_open();
    let studio = Arc::new(Studio {
        id: random()?,
        address,
        models,
        opened,
        pages: Pages::default(),
        studies: Studies::default(),
        ending: Arc::default(),
    });
    session.patient(true);
    text::print(&format!("{to_open}\n"));
    if !options.no_browser && can_be_seen() {
        // If no browser opens, the user has the address.
        if let Err(error) = open::that_detached(&to_open) {
            session.remark(&format!("no browser could be opened ({error}); open the address above"));
        }
    }
    if std::io::stderr().is_terminal() {
        text::complain("Press Ctrl-C to stop the server.\n");
    }
    let served = serve(listener, &studio, session);
    served.map(|()| Outcome::Done).map_err(|e| failed("the server failed".into(), &e))
}

/// Folder of a model and its name in it. The model must exist; it may have errors.
fn of_model(session: &Session, model: &Path) -> Result<(PathBuf, Option<String>), Outcome> {
    if model.is_dir() {
        return Ok((model.into(), None));
    }
    if let Err(error) = hardpoint_file::read(model)
        && matches!(error, hardpoint_file::ReadError::Unreadable(_))
    {
        session.not_read(error.diagnostics());
        return Err(Outcome::BadModel);
    }
    let folder = model.parent().unwrap_or(Path::new(""));
    let name = model.file_name().map(|n| n.to_string_lossy().into_owned());
    Ok((folder.into(), name))
}

/// The current folder if it has models, or `models` in it.
fn of_gallery() -> PathBuf {
    let has_models = |path: &Path| Models::of(path).is_ok_and(|models| !models.list().is_empty());
    let beside = Path::new("models");
    let here = Path::new("");
    if !has_models(here) && has_models(beside) { beside.into() } else { here.into() }
}

/// True if a browser could be displayed.
fn can_be_seen() -> bool {
    let given = |name| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    !cfg!(any(target_os = "linux", target_os = "freebsd"))
        || given("DISPLAY")
        || given("WAYLAND_DISPLAY")
        || given("BROWSER")
}
