#[test]
fn try_it() {
    let Ok(path) = std::env::var("TRY") else { return };
    let bytes = std::fs::read(&path).unwrap();
    let dir = std::path::Path::new(&path).parent().unwrap().to_owned();
    match hardpoint_import::import(&bytes, &path, &|p| std::fs::read(dir.join(p)).ok()) {
        Ok(i) => println!("{}\n{}\n{:?}", i.text, i.report, i.fault.map(|f| f.to_string())),
        Err(e) => e.iter().for_each(|m| println!("{m}")),
    }
}
