fn main() {
    let f = hardpoint_file::read(std::path::Path::new(&std::env::args().nth(1).unwrap()))
        .unwrap_or_else(|e| panic!("{e}"));
    let a = hardpoint::Analysis::new(&f.model).unwrap();
    for (k, c) in a.topology().closures.iter().enumerate() {
        println!(
            "{k} {:?} {:?} rows {:?} block {:?} entries {:?}",
            f.model.joints[c.joint.0].name, c.driver, c.rows, c.block, c.entries
        );
    }
    for (k, b) in a.topology().blocks.iter().enumerate() {
        println!("block {k} {:?} sel {:?} links {:?}", b.unknowns, b.selected, b.links);
    }
    let s = a.run_motion();
    println!("{:?}", s.stop);
    for (b, st) in s.motion.at(0).iter().enumerate() {
        println!("{} r {:?} v {:?} a {:?}", f.model.bodies[b].name, st.r, st.v, st.a);
    }
    println!("{:?}", s.motion.coordinates);
}
