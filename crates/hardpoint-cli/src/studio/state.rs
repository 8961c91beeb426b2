//! State of a server.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::address::Address;
use super::folder::Models;
use super::pages::Pages;
use super::studies::Studies;

/// State of a server, shared by its connections.
pub(super) struct Studio {
    /// Identity of this server, to distinguish it from an earlier one at the same address.
    pub id: String,
    pub address: Address,
    pub models: Models,
    /// The model that the server was started with.
    pub opened: Option<String>,
    pub pages: Pages,
    pub studies: Studies,
    /// Set when the server is to stop.
    pub ending: Arc<AtomicBool>,
}
