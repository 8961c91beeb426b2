//! The command as users see it: output, files and exit codes.

mod bench;
mod calibrate;
mod client;
mod dxf;
mod fmu;
mod gltf;
mod golden;
mod help;
mod import;
mod joint_limits;
mod map;
mod new;
mod optimize;
mod pdf;
mod results;
mod studio;
mod sweep;
mod synthesize;
mod there_and_back;
mod tolerance;
mod whatif;
mod workbook;
