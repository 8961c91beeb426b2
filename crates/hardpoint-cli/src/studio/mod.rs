//! `hardpoint studio`: the page of a model from a server on this machine, which saves, watches files and runs long
//! studies.
//!
//! | file | contents |
//! |---|---|
//! | `command.rs` | start of a server, from the options of the command |
//! | `state.rs` | state of a server |
//! | `address.rs` | access control |
//! | `server.rs` | connections, limits, responses |
//! | `routes.rs` | requests and their answers |
//! | `folder.rs` | the model files of the folder, read and saved |
//! | `page.rs` | pages of models, the gallery |
//! | `pages.rs` | cache of pages and drawings |
//! | `watch.rs` | events for pages |
//! | `studies.rs` | studies in threads of their own |

mod address;
mod command;
mod folder;
mod page;
mod pages;
mod routes;
mod server;
mod state;
mod studies;
mod watch;

pub use address::given_token;
pub use command::run;
