//! Pages, tables and facts of solved models, as users see them.

mod accidents;
mod drawing;
mod elastic;
mod files;
mod mesh;
mod opening;
mod rockers;
mod shapes;
mod shown;
mod synthesis;
mod weight;
mod whatif;
mod windows;
