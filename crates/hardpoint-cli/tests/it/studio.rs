//! `hardpoint studio` for pages, other programs and attackers; `hardpoint site`.

use std::io::{Read, Write};
use std::path::Path;

use crate::bench::Bench;
use crate::client::Server;

const TOKEN: &str = "a-token-of-this-test";

fn study_file(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/studies").join(name);
    std::fs::read_to_string(path).unwrap()
}

fn slider() -> Bench {
    Bench::with(&["slider.toml"])
}

/// Contents of a page's packed block.
fn payload(bench: &Bench, html: &str) -> serde_json::Value {
    bench.put("served.html", html);
    let page = bench.page("served.html");
    std::fs::remove_file(bench.path("served.html")).unwrap();
    page
}

/// Data about the server in a page.
fn about(html: &str) -> serde_json::Value {
    let (_, rest) = html.split_once("id=\"server\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn the_page_is_that_of_run_and_its_token_moves_from_the_address_to_a_cookie() {
    let bench = slider();
    let server = Server::start(&bench, &["slider.toml"]);
    let host = format!("host: 127.0.0.1:{}\r\nconnection: close\r\n", server.port);
    let first = server.send(&format!("GET /?token={}&case= HTTP/1.1\r\n{host}\r\n", server.token));
    assert_eq!((first.status, first.header("location")), (303, Some("/?case=")));
    let cookie = first.header("set-cookie").unwrap();
    assert!(cookie.ends_with("; Path=/; HttpOnly; SameSite=Strict"), "{cookie}");
    let cookie = cookie.split(';').next().unwrap();
    let page = server.send(&format!("GET / HTTP/1.1\r\n{host}cookie: {cookie}\r\n\r\n"));
    assert_eq!(page.status, 200, "{}", page.head);
    assert_eq!(page.header("content-type"), Some("text/html; charset=utf-8"));
    assert!(bench.list("results").is_empty(), "a page that is looked at writes nothing");

    let mut served = payload(&bench, &page.body);
    assert_eq!(bench.run(&["run", "slider.toml"]).status.code(), Some(0));
    assert!(bench.text("results/slider/report.html").contains("id=\"server\"></script>"));
    let mut written = bench.page("results/slider/report.html");
    for of in [&mut served, &mut written] {
        // Durations depend on the machine.
        of.as_object_mut().unwrap().remove("summary");
        of.as_object_mut().unwrap().remove("checks");
    }
    assert_eq!(served, written);

    let facts = about(&page.body);
    assert_eq!((&facts["file"], &facts["token"]), (&"slider.toml".into(), &server.token.as_str().into()));
    assert_eq!(facts["revision"], server.revision("slider.toml"));
    assert_eq!(server.interrupt().code(), Some(0));
}

#[test]
fn requests_without_token_or_of_other_origin_are_rejected_with_a_reason() {
    let bench = slider();
    let server = Server::start(&bench, &["slider.toml", "--token", TOKEN]);
    assert_eq!(server.token, TOKEN);
    let here = format!("host: localhost:{}\r\n", server.port);
    let token = format!("x-hardpoint-token: {TOKEN}\r\n");
    let ask = |path: &str, headers: &str| {
        server.send(&format!("GET {path} HTTP/1.1\r\n{headers}connection: close\r\n\r\n"))
    };
    let whole = ask("/api/models", &format!("{here}{token}"));
    assert_eq!(whole.status, 200);
    assert_eq!(whole.header("cache-control"), Some("no-store"));
    assert_eq!(whole.header("x-content-type-options"), Some("nosniff"));
    let policy = whole.header("content-security-policy").unwrap();
    assert!(policy.contains("default-src 'none'") && !policy.contains("http"), "{policy}");
    assert!(!whole.head.to_lowercase().contains("access-control"), "{}", whole.head);

    let own = format!("origin: http://127.0.0.1:{}\r\n", server.port);
    assert_eq!(ask("/api/models", &format!("{here}{token}{own}")).status, 200);
    let elsewhere = [
        ("/api/models", here.clone()),
        ("/", here.clone()),
        ("/?token=guessed", here.clone()),
        ("/nothing", here.clone()),
        ("/api/models", format!("{here}x-hardpoint-token: {}\r\n", TOKEN.to_uppercase())),
        ("/api/models", format!("host: evil.example:{}\r\n{token}", server.port)),
        ("/api/models", format!("host: 127.0.0.1\r\n{token}")),
        ("/api/models", format!("{here}{token}origin: http://evil.example\r\n")),
        ("/api/models", format!("{here}{token}origin: http://localhost:1\r\n")),
        ("/api/models", format!("{here}{token}origin: null\r\n")),
        ("/api/models", format!("{here}{token}sec-fetch-site: cross-site\r\n")),
        ("http://evil.example/api/models", format!("{here}{token}")),
    ];
    for (path, headers) in elsewhere {
        let refused = ask(path, &headers);
        assert_eq!(refused.status, 403, "{path} {headers}{}", refused.head);
        assert!(
            refused.body.starts_with("This ") && refused.body.trim_end().ends_with(['.']),
            "{}",
            refused.body
        );
        assert!(!refused.body.contains(TOKEN));
    }
}

#[test]
fn a_text_is_saved_over_the_revision_that_it_was_made_from_and_no_other() {
    let bench = slider();
    let server = Server::start(&bench, &["slider.toml"]);
    let read = server.get("/api/model?file=slider.toml").json();
    let before = bench.text("slider.toml");
    assert_eq!(read["text"], before);
    let revision = read["revision"].as_str().unwrap();

    let mine = format!("{before}# mine\n");
    let saved = server.put("file=slider.toml", revision, &mine);
    assert_eq!(saved.status, 200, "{}", saved.body);
    assert_eq!(bench.text("slider.toml"), mine);
    let revision_of_mine = saved.json()["revision"].as_str().unwrap().to_owned();
    assert_eq!(server.revision("slider.toml"), revision_of_mine);

    // Another program changed the file: its text is returned and stays.
    let theirs = format!("{before}# theirs\n");
    bench.put("slider.toml", &theirs);
    let conflict = server.put("file=slider.toml", &revision_of_mine, &before);
    assert_eq!((conflict.status, &conflict.json()["text"]), (409, &theirs.as_str().into()));
    assert_eq!(bench.text("slider.toml"), theirs);
    let revision = conflict.json()["revision"].as_str().unwrap().to_owned();

    let wrong = before.replace("at = \"B\"", "at = \"BB\"");
    let refused = server.put("file=slider.toml", &revision, &wrong);
    assert_eq!(refused.status, 422);
    let found = refused.json();
    assert!(
        found["diagnostics"][0]["line"].is_u64() && found["text"].as_str().unwrap().contains("slider.toml:")
    );
    assert_eq!(bench.text("slider.toml"), theirs);
    assert_eq!(server.put("file=slider.toml&anyway=1", &revision, &wrong).status, 200);
    assert_eq!(bench.text("slider.toml"), wrong);
    // The page then shows the errors.
    let page = server.get("/");
    assert_eq!(page.status, 200);
    assert!(page.body.contains("data-testid=\"trouble\"") && page.body.contains("class=\"at\""));
    assert_eq!(about(&page.body)["file"], "slider.toml");

    assert_eq!(server.ask("PUT", "/api/model?file=slider.toml", "", &before).status, 428);
    assert_eq!(server.put("file=none.toml", &revision, &before).status, 404);

    let new = server.ask("POST", "/api/model?file=new%20one.toml", "", &before);
    assert_eq!(new.status, 201, "{}", new.body);
    assert_eq!(bench.text("new one.toml"), before);
    assert_eq!(server.ask("POST", "/api/model?file=new+one.toml", "", &mine).status, 409);
    assert_eq!(bench.text("new one.toml"), before);
    assert_eq!(bench.list(""), ["new one.toml", "slider.toml"], "nothing is left under way");
}

#[test]
fn no_name_leads_out_of_the_folder_or_to_other_files() {
    let bench = slider();
    let text = bench.text("slider.toml");
    std::fs::create_dir(bench.path("inside")).unwrap();
    std::fs::create_dir(bench.path("folder.toml")).unwrap();
    bench.put("outside.toml", &text);
    bench.put("secret.txt", "secret");
    bench.put("inside/slider.toml", &text);
    bench.put("inside/.hidden.toml", &text);
    let server = Server::start(&bench, &["inside/slider.toml"]);
    let absolute = bench.path("outside.toml").display().to_string();
    let mut names: Vec<String> = [
        "../outside.toml",
        "..%2Foutside.toml",
        "%2e%2e/outside.toml",
        "..%252Foutside.toml",
        "..%5Coutside.toml",
        "..\\outside.toml",
        "./slider.toml",
        "inside/slider.toml",
        "slider.toml/",
        "slider.toml/../slider.toml",
        "slider.toml%00",
        "slider.toml%00.toml",
        "%00",
        ".hidden.toml",
        "C:outside.toml",
        "slider.toml:stream.toml",
        "%FF.toml",
        "..",
        ".toml",
        "",
        "../secret.txt",
        "secret.txt",
        "slider.TOML.txt",
    ]
    .map(String::from)
    .into();
    names.push(absolute.clone());
    names.push(absolute.replace('/', "%2F"));
    names.push(format!("file://{absolute}"));
    names.push(format!("{}.toml", "a".repeat(5000)));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../outside.toml", bench.path("inside/link.toml")).unwrap();
        std::os::unix::fs::symlink("../folder.toml", bench.path("inside/folder.toml")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", bench.path("inside/zero.toml")).unwrap();
        names.extend(["link.toml", "folder.toml", "zero.toml"].map(String::from));
    }
    let is_refused = |status: u16| (400..500).contains(&status);
    let links = ["link.toml", "folder.toml", "zero.toml"];
    for name in &names {
        for path in [format!("/api/model?file={name}"), format!("/?file={name}")] {
            let read = server.get(&path);
            assert!(is_refused(read.status), "{path}: {} {}", read.status, read.body);
            assert!(!read.body.contains("secret\n") && !read.body.contains("[hardpoints]"), "{path}");
        }
        let saved = server.put(&format!("file={name}&anyway=1"), &server.revision("slider.toml"), "mine");
        assert!(is_refused(saved.status), "{name}: {}", saved.status);
        let new = server.ask("POST", &format!("/api/model?file={name}&anyway=1"), "", "mine");
        assert!(is_refused(new.status), "{name}: {} {}", new.status, new.body);
        let study = serde_json::json!({ "what": "optimize", "file": name, "text": text }).to_string();
        let study = server.ask("POST", "/api/study", "", &study);
        assert!(
            is_refused(study.status) || name.contains('%') || links.contains(&name.as_str()),
            "{name}: {}",
            study.status
        );
    }
    for path in [
        "/api/model",
        "/api",
        "/api/model/slider.toml",
        "/slider.toml",
        "//",
        "/api//models",
        "/api/study/",
        "/api/study/1/x",
        "/../outside.toml",
        "/api/study/99999999999999999999",
        "/api/study/1/report.html",
    ] {
        let status = server.get(path).status;
        assert!(status == 404 || status == 400, "{path}: {status}");
    }
    assert_eq!((bench.text("outside.toml"), bench.text("inside/slider.toml")), (text.clone(), text));
    assert_eq!(bench.text("secret.txt"), "secret");
    let kept: &[&str] = if cfg!(unix) {
        &[".hidden.toml", "folder.toml", "link.toml", "slider.toml", "zero.toml"]
    } else {
        &[".hidden.toml", "slider.toml"]
    };
    assert_eq!(bench.list("inside"), kept);
    let listed = server.get("/api/models").json();
    assert_eq!(listed["models"].as_array().unwrap().len(), 1, "{listed}");
}

#[test]
fn a_model_that_is_not_there_is_a_page_with_a_way_to_the_others() {
    let bench = Bench::with(&["slider.toml"]);
    let server = Server::start(&bench, &["slider.toml"]);
    let page = server.get("/?file=nosuch.toml");
    assert_eq!(page.status, 404);
    assert!(page.body.contains("there is no `nosuch.toml` in this folder"), "{}", page.body);
    assert!(page.body.starts_with("<!doctype html>") && page.body.contains("href=\"/gallery\""));
    let answer = server.get("/api/model?file=nosuch.toml");
    assert_eq!((answer.status, answer.json()["error"].is_string()), (404, true));
}

/// A symbolic link within the folder is another name: its target is saved, and the link remains.
#[cfg(unix)]
#[test]
fn links_to_a_model_survive_saving() {
    use std::os::unix::fs::PermissionsExt;
    let bench = slider();
    std::os::unix::fs::symlink("slider.toml", bench.path("link.toml")).unwrap();
    std::fs::set_permissions(bench.path("slider.toml"), PermissionsExt::from_mode(0o600)).unwrap();
    let server = Server::start(&bench, &["link.toml"]);
    let mine = bench.text("slider.toml") + "# mine\n";
    assert_eq!(server.put("file=link.toml", &server.revision("link.toml"), &mine).status, 200);
    assert_eq!(bench.text("slider.toml"), mine);
    assert!(std::fs::symlink_metadata(bench.path("link.toml")).unwrap().is_symlink());
    let mode = std::fs::metadata(bench.path("slider.toml")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    std::fs::set_permissions(bench.path("slider.toml"), PermissionsExt::from_mode(0o400)).unwrap();
    let refused = server.put("file=link.toml", &server.revision("link.toml"), "x");
    assert!(refused.status >= 400, "{}", refused.status);
    let refused = server.put("file=link.toml&anyway=1", &server.revision("link.toml"), "x");
    assert!(refused.status == 500 && refused.body.contains("read-only"), "{}", refused.body);
    assert_eq!(bench.text("slider.toml"), mine);
}

#[test]
fn sizes_of_bodies_and_methods_are_checked() {
    let bench = slider();
    let server = Server::start(&bench, &["slider.toml"]);
    let head = server.head("PUT", "/api/model?file=slider.toml") + "if-match: x\r\n";
    // Rejected by its declared length, before the body arrives.
    let reply = server.send(&format!("{head}content-length: 1000000000000\r\n\r\n"));
    assert_eq!(reply.status, 413, "{}", reply.head);
    assert!(reply.json()["error"].as_str().unwrap().contains("64 MiB"));
    // Without a declared length.
    let mut stream = server.connect();
    stream.write_all(format!("{head}transfer-encoding: chunked\r\n\r\n").as_bytes()).unwrap();
    let chunk = [format!("{:x}\r\n", 1 << 20).into_bytes(), vec![b'#'; 1 << 20], b"\r\n".to_vec()].concat();
    for _ in 0..80 {
        if stream.write_all(&chunk).is_err() {
            break;
        }
    }
    let mut reply = Vec::new();
    let _ = stream.read_to_end(&mut reply);
    assert!(reply.starts_with(b"HTTP/1.1 413"), "{}", String::from_utf8_lossy(&reply));

    for (method, path, allow) in [
        ("POST", "/", "GET"),
        ("DELETE", "/api/model?file=slider.toml", "GET, POST, PUT"),
        ("PUT", "/api/study", "POST"),
        ("PATCH", "/api/study/1", "DELETE, GET"),
        ("OPTIONS", "/api/models", "GET"),
        ("BREW", "/api/events", "GET"),
    ] {
        let refused = server.ask(method, path, "", "");
        assert_eq!((refused.status, refused.header("allow")), (405, Some(allow)), "{method} {path}");
    }
    assert_eq!(server.ask("POST", "/api/study", "", "no JSON").status, 400);
    assert_eq!(
        server.ask("POST", "/api/study", "", r#"{"what":"dance","file":"slider.toml","text":""}"#).status,
        400
    );
    assert_eq!(server.ask("POST", "/api/model?file=a.toml&anyway=1", "", "\u{0}").status, 201);
    let mut bytes = server.head("POST", "/api/model?file=b.toml&anyway=1").into_bytes();
    bytes.extend(b"content-length: 2\r\n\r\n\xff\xfe");
    assert!(server.raw(&bytes).starts_with(b"HTTP/1.1 400"));
    assert_eq!(bench.list(""), ["a.toml", "slider.toml"]);
}

#[test]
fn invalid_and_unfinished_requests_do_not_block_other_clients() {
    let bench = slider();
    let server = Server::start(&bench, &["slider.toml"]);
    let mut garbage: Vec<Vec<u8>> = [
        &b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03"[..],
        b"\0\0\0\0\0\0\0\0\r\n\r\n",
        b"GET\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"GET / HTTP/1.1\r\nhost : x\r\n\r\n",
        b"GET / HTTP/1.1\r\ncontent-length: -1\r\n\r\n",
        b"POST / HTTP/1.1\r\ncontent-length: 3\r\ntransfer-encoding: chunked\r\n\r\nabc",
        b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
        b"CONNECT evil.example:443 HTTP/1.1\r\n\r\n",
        b"\r\n\r\n\r\n\r\n",
    ]
    .map(Vec::from)
    .into();
    garbage.push(vec![b'A'; 1 << 20]);
    garbage.push([b"GET / HTTP/1.1\r\nx: ".to_vec(), vec![b'y'; 1 << 20]].concat());
    garbage.push([b"GET / HTTP/1.1\r\n".to_vec(), b"a: b\r\n".repeat(5000), b"\r\n".to_vec()].concat());
    garbage.push((0..4096_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect());
    for bytes in garbage {
        let mut stream = server.connect();
        let _ = stream.write_all(&bytes);
        let _ = stream.shutdown(std::net::Shutdown::Write);
        let mut reply = Vec::new();
        let _ = stream.read_to_end(&mut reply);
        let text = String::from_utf8_lossy(&reply);
        assert!(reply.is_empty() || text.starts_with("HTTP/1.1 4"), "{text}");
    }
    // Incomplete heads and bodies, and answers that are never read.
    let body =
        server.head("PUT", "/api/model?file=slider.toml") + "if-match: x\r\ncontent-length: 100\r\n\r\nhalf";
    let whole = server.head("GET", "/") + "\r\n";
    let mut held = Vec::new();
    for k in 0..90 {
        let mut stream = server.connect();
        let part = ["GET / HT", &body, &whole][k % 3];
        stream.write_all(part.as_bytes()).unwrap();
        held.push(stream);
    }
    assert_eq!(server.get("/api/models").status, 200);
    assert_eq!(server.get("/").status, 200);
    drop(held);
    assert_eq!(server.get("/api/models").status, 200);
}

#[test]
fn fifty_simultaneous_clients_get_their_answers() {
    let bench = slider();
    let server = Server::start(&bench, &["slider.toml"]);
    let text = bench.text("slider.toml");
    let page = payload(&bench, &server.get("/").body);
    let pages: Vec<String> = std::thread::scope(|scope| {
        let clients: Vec<_> = (0..50)
            .map(|k| {
                let (server, text) = (&server, &text);
                scope.spawn(move || {
                    let mut events = server.events("file=slider.toml");
                    assert_eq!(events.next().0, "hello");
                    let own = format!("{text}# client {k}\n");
                    let name = format!("client_{k}.toml");
                    assert_eq!(server.ask("POST", &format!("/api/model?file={name}"), "", &own).status, 201);
                    assert_eq!(server.get(&format!("/api/model?file={name}")).json()["text"], own);
                    assert_eq!(server.get(&format!("/nothing/{k}")).status, 404);
                    // Of several clients that save over the same revision, only the first succeeds.
                    server.get("/").body
                })
            })
            .collect();
        clients.into_iter().map(|c| c.join().unwrap()).collect()
    });
    for html in pages {
        assert_eq!(payload(&bench, &html)["quantities"], page["quantities"]);
    }
    assert_eq!(server.get("/api/models").json()["models"].as_array().unwrap().len(), 51);

    let revision = server.revision("slider.toml");
    let statuses: Vec<u16> = std::thread::scope(|scope| {
        let (server, text, revision) = (&server, &text, &revision);
        let save = |k: usize| {
            scope.spawn(move || server.put("file=slider.toml", revision, &format!("{text}# {k}\n")).status)
        };
        let clients: Vec<_> = (0..50).map(save).collect();
        clients.into_iter().map(|c| c.join().unwrap()).collect()
    });
    assert_eq!(statuses.iter().filter(|s| **s == 200).count(), 1, "{statuses:?}");
    assert_eq!(statuses.iter().filter(|s| **s == 409).count(), 49, "{statuses:?}");
}

#[test]
fn a_page_receives_changes_by_others_and_not_its_own() {
    let bench = slider();
    let text = bench.text("slider.toml");
    let server = Server::start(&bench, &["slider.toml"]);
    let mut mine = server.events("file=slider.toml&client=mine");
    let mut other = server.events("file=slider.toml&client=other");
    let (name, hello) = mine.next();
    let first = hello["revision"].as_str().unwrap();
    assert_eq!((name.as_str(), first), ("hello", server.revision("slider.toml").as_str()));
    other.next();

    let saved = server.put("file=slider.toml&client=mine", first, &format!("{text}# mine\n"));
    assert_eq!(other.next_of("changed")["revision"], saved.json()["revision"]);
    // The same length, and perhaps the same time: the bytes count.
    bench.put("slider.toml", &format!("{text}# MINE\n"));
    let heard = mine.next_of("changed");
    assert_eq!(
        (&heard["file"], &heard["revision"]),
        (&"slider.toml".into(), &server.revision("slider.toml").into())
    );
    assert_eq!(other.next_of("changed"), heard);

    std::fs::remove_file(bench.path("slider.toml")).unwrap();
    assert!(mine.next_of("changed")["revision"].is_null());
    assert_eq!(server.get("/").status, 404);
    bench.put("slider.toml", &text);
    assert_eq!(mine.next_of("changed")["revision"], first);
}

#[test]
fn a_search_reports_progress_and_returns_a_report_and_the_optimised_model() {
    let bench = slider();
    let text = study_file("strut_toe.toml");
    bench.put("strut.toml", &text);
    let server = Server::start(&bench, &["strut.toml"]);
    let mut events = server.events("");
    let asked = serde_json::json!({ "what": "optimize", "file": "strut.toml", "text": text, "options": { "iterations": 40 } });
    let begun = server.ask("POST", "/api/study", "", &asked.to_string());
    assert_eq!(begun.status, 202, "{}", begun.body);
    let id = begun.json()["id"].clone();
    let mut lines = 0;
    let end = loop {
        let event = events.next_of("study");
        assert_eq!(event["id"], id);
        lines += usize::from(event["line"].is_string());
        if event["state"] != "running" {
            break event;
        }
    };
    assert_eq!(end["state"], "done", "{end}");
    assert!(lines > 3, "{lines}");
    let whole = server.get(&format!("/api/study/{id}")).json();
    let found = whole["text"].as_str().unwrap();
    let reports = whole["reports"].as_array().unwrap();
    assert_eq!(reports.iter().map(|r| r["case"].as_str().unwrap()).collect::<Vec<_>>(), ["bump", "steer"]);
    for report in reports {
        let page = server.get(report["link"].as_str().unwrap());
        assert_eq!(page.status, 200);
        assert_eq!(payload(&bench, &page.body)["designs"][0]["name"], "found");
    }
    assert_eq!(bench.text("strut.toml"), text, "a study writes nothing");

    // The command finds the same.
    let output = bench.run(&["optimize", "strut.toml", "--save", "found.toml"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(found, bench.text("found.toml"));

    let wrong = serde_json::json!({ "what": "optimize", "file": "strut.toml", "text": "name = 1" });
    assert_eq!(server.ask("POST", "/api/study", "", &wrong.to_string()).status, 422);
    // A model that cannot be searched is reported when the study ends.
    let slider =
        serde_json::json!({ "what": "optimize", "file": "slider.toml", "text": bench.text("slider.toml") });
    let id = server.ask("POST", "/api/study", "", &slider.to_string()).json()["id"].clone();
    let end = loop {
        let event = events.next_of("study");
        if event["id"] == id && event["state"] != "running" {
            break event;
        }
    };
    assert_eq!((&end["state"], &end["diagnostics"][0]["code"]), (&"failed".into(), &"HP0602".into()));
}

#[test]
fn a_sweep_leaves_its_designs_on_the_page_and_nothing_on_disk() {
    let bench = slider();
    let server = Server::start(&bench, &["slider.toml"]);
    let mut events = server.events("");
    let asked = serde_json::json!({
        "what": "sweep", "file": "sweep.toml", "text": study_file("strut_sweep.toml"), "case": "bump", "options": { "samples": 16 },
    });
    assert_eq!(server.ask("POST", "/api/study", "", &asked.to_string()).status, 202);
    let end = loop {
        let event = events.next_of("study");
        if event["state"] != "running" {
            break event;
        }
    };
    assert_eq!(end["state"], "done", "{end}");
    let report = server.get(end["reports"][0]["link"].as_str().unwrap());
    assert_eq!(payload(&bench, &report.body)["sweep"]["what"], "design");
    assert_eq!(bench.list(""), ["slider.toml"]);
}

#[test]
fn a_cancelled_study_keeps_its_results_and_at_most_two_run() {
    let bench = slider();
    let text = study_file("strut_tolerances.toml");
    let server = Server::start(&bench, &["slider.toml"]);
    let mut events = server.events("");
    let asked = serde_json::json!({
        "what": "tolerance", "file": "strut.toml", "text": text, "case": "bump", "options": { "samples": 10_000_000 },
    });
    let begin = || server.ask("POST", "/api/study", "", &asked.to_string());
    let [first, second] = [begin(), begin()].map(|b| b.json()["id"].as_u64().unwrap());
    let third = begin();
    assert_eq!(third.status, 429);
    let mut drawn = |id: u64| loop {
        let event = events.next_of("study");
        if event["id"] == id
            && event["progress"]["unit"] == "designs"
            && event["progress"]["done"].as_u64() > Some(0)
        {
            break;
        }
    };
    drawn(first);
    assert_eq!(server.ask("DELETE", &format!("/api/study/{first}"), "", "").status, 202);
    let end = loop {
        let event = events.next_of("study");
        if event["id"] == first && event["state"] != "running" {
            break event;
        }
    };
    assert_eq!(end["state"], "cancelled", "{end}");
    let report = server.get(end["reports"][0]["link"].as_str().unwrap());
    assert!(!payload(&bench, &report.body)["designs"].as_array().unwrap().is_empty());
    assert_eq!(server.get(&format!("/api/study/{second}")).json()["state"], "running");
    // A server cancels its studies when it stops.
    assert_eq!(server.interrupt().code(), Some(0));
}

#[test]
fn a_server_that_was_killed_is_found_again_on_its_port_with_its_token() {
    let bench = slider();
    let mut server = Server::start(&bench, &["slider.toml", "--token", TOKEN]);
    let mut events = server.events("file=slider.toml");
    let hello = events.next().1;
    server.kill();
    let port = server.port.to_string();
    let again = Server::start(&bench, &["slider.toml", "--token", TOKEN, "--port", &port]);
    let second = again.events("file=slider.toml").next().1;
    assert_eq!(hello["revision"], second["revision"]);
    assert_ne!(hello["server"], second["server"]);
    assert_eq!(server.get("/").status, 200, "by the address of the first");

    let taken = bench.run(&["studio", "--no-browser", "--port", &port]);
    assert_eq!(taken.status.code(), Some(2));
    let message = String::from_utf8_lossy(&taken.stderr);
    assert!(message.contains("HP0604") && message.contains("--port"), "{message}");
    assert_eq!(bench.run(&["studio", "--no-browser", "--token", "short"]).status.code(), Some(2));
    assert_eq!(bench.run(&["studio", "--no-browser", "none.toml"]).status.code(), Some(3));
}

#[test]
fn without_a_model_all_models_are_shown_and_no_other_files() {
    let bench = Bench::with(&[]);
    std::fs::create_dir(bench.path("models")).unwrap();
    let slider = slider().text("slider.toml");
    bench.put("models/slider.toml", &slider);
    bench.put("models/strut.toml", &study_file("strut_toe.toml"));
    bench.put("models/broken.toml", "[hardpoints]\nA = [");
    bench.put("models/Cargo.toml", "[package]\nname = \"x\"\n");
    let server = Server::start(&bench, &[]);
    let listed = server.get("/api/models").json();
    let files: Vec<&str> =
        listed["models"].as_array().unwrap().iter().map(|m| m["file"].as_str().unwrap()).collect();
    assert_eq!(files, ["broken.toml", "slider.toml", "strut.toml"]);
    let page = server.get("/").body;
    assert!(
        page.contains("href=\"/?file=slider.toml\"")
            && page.contains("href=\"/?file=strut.toml&amp;case=steer\"")
    );
    assert!(page.contains("1 problem") && about(&page)["file"].is_null());
    let steer = server.get("/?file=strut.toml&case=steer");
    assert_eq!(about(&steer.body)["case"], "steer");
    assert_eq!(about(&steer.body)["cases"], serde_json::json!(["bump", "steer"]));
    let none = server.get("/?file=strut.toml&case=none");
    assert!(none.body.contains("data-testid=\"trouble\"") && none.body.contains("there is no case named"));
}

#[test]
fn drawings_of_the_gallery_follow_the_files() {
    let bench = slider();
    bench.put("broken.toml", "[hardpoints]\nA = [");
    let server = Server::start(&bench, &["slider.toml"]);
    let gallery = server.get("/gallery").body;
    assert!(gallery.contains("data-drawing=\"/api/drawing?file=slider.toml\""));
    // A model with errors has none.
    assert_eq!(gallery.matches("data-drawing=\"").count(), 1);
    let drawing = |file: &str| server.get(&format!("/api/drawing?file={file}"));
    let svg = |file: &str| drawing(file).json()["svg"].as_str().unwrap().to_owned();
    let first = svg("slider.toml");
    assert!(first.starts_with("<svg") && first.contains("<polygon") && !first.contains("NaN"), "{first}");
    assert_eq!(svg("slider.toml"), first);
    assert_eq!(svg("broken.toml"), "");
    bench.put("slider.toml", &study_file("strut_toe.toml"));
    let second = svg("slider.toml");
    assert!(second.starts_with("<svg") && second != first);
    assert_eq!((drawing("none.toml").status, drawing("..%2Fx.toml").status), (404, 400));
    assert_eq!(server.get("/api/drawing").status, 400);
}

#[test]
fn a_new_linkage_has_a_page_and_gets_its_file_when_it_is_saved() {
    let bench = slider();
    bench.put("linkage.toml", "name = 1");
    let server = Server::start(&bench, &["slider.toml"]);
    assert!(server.get("/gallery").body.contains("data-testid=\"new-linkage\" href=\"/new\""));
    let page = server.get("/new").body;
    let facts = about(&page);
    // The name of a file that is there is not taken.
    assert_eq!((&facts["file"], facts["revision"].is_null()), (&"linkage-2.toml".into(), true));
    let page = payload(&bench, &page);
    assert_eq!((&page["title"], page["status"]["complete"].as_bool()), (&"linkage".into(), Some(true)));
    let text = page["model"]["text"].as_str().unwrap();
    assert_eq!(bench.list("").iter().filter(|name| name.starts_with("linkage")).count(), 1);
    let saved = server.ask("POST", "/api/model?file=linkage-2.toml", "", text);
    assert_eq!((saved.status, bench.text("linkage-2.toml")), (201, text.to_owned()));
    assert_eq!(about(&server.get("/new").body)["file"], "linkage-3.toml");
    assert_eq!(server.ask("POST", "/new", "", "").status, 405);
}

#[test]
fn a_site_has_a_page_for_each_model_that_can_be_shown() {
    let bench = slider();
    bench.put("strut & co.toml", &study_file("strut_toe.toml"));
    bench.put("broken.toml", "[hardpoints]");
    let output = bench.run(&["site", "public", "slider.toml", "strut & co.toml", "broken.toml"]);
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
    let pages =
        ["hardpoint.js", "index.html", "slider.html", "strut%20%26%20co-steer.html", "strut%20%26%20co.html"];
    assert_eq!(bench.list("public"), pages);
    let index = bench.text("public/index.html");
    assert!(
        index.contains("href=\"slider.html\"")
            && index.contains("href=\"strut%2520%2526%2520co-steer.html\"")
    );
    assert!(!index.contains("broken"));
    // Each card has a drawing, and each page a link to the gallery.
    assert_eq!(index.matches("<svg").count(), 2);
    assert!(index.contains("<polygon") && index.contains("<circle") && !index.contains("NaN"));
    assert!(bench.text("public/slider.html").contains("<link rel=\"up\" href=\"index.html\">"));
    assert!(bench.page("public/slider.html")["quantities"].is_array());
    // The engine is there once, for all pages.
    let [engine, one] =
        ["hardpoint.js", "slider.html"].map(|file| bench.text(&format!("public/{file}")).len());
    assert!(one < engine / 3, "{one} of {engine} bytes");

    let nothing = bench.run(&["site", "nothing", "broken.toml"]);
    assert_eq!((nothing.status.code(), bench.list("nothing").len()), (Some(3), 0));
    let twice = bench.run(&["site", "twice", "slider.toml", "./slider.toml"]);
    assert_eq!(twice.status.code(), Some(2));
    assert_eq!(bench.run(&["site", "none"]).status.code(), Some(2));
}

#[test]
fn a_task_is_solved_and_every_answer_has_its_page() {
    let bench = slider();
    let server = Server::start(&bench, &["slider.toml"]);
    let text = bench.text("slider.toml");
    let solve = |task: &str| {
        let asked = serde_json::json!({ "what": "synthesize", "file": "slider.toml", "text": text, "options": { "task": task } });
        let begun = server.ask("POST", "/api/study", "", &asked.to_string());
        assert_eq!(begun.status, 202, "{}", begun.body);
        let link = format!("/api/study/{}", begun.json()["id"]);
        loop {
            let study = server.get(&link).json();
            if study["state"] != "running" {
                return study;
            }
            std::thread::sleep(std::time::Duration::from_millis(50));
        }
    };
    let units = "name = \"lid\"\nunits = { length = \"mm\", angle = \"deg\" }\n";
    let found = solve(&format!("{units}poses = [[0, 0, 0], [230, 280, 40], [250, 620, 95]]\nanswers = 2\n"));
    assert_eq!(found["state"], "done", "{found}");
    let reports = found["reports"].as_array().unwrap();
    assert_eq!(reports.len(), 2, "{found}");
    for (k, report) in reports.iter().enumerate() {
        assert!(report["case"].as_str().unwrap().starts_with(&format!("{}: ", k + 1)), "{report}");
        let page = server.get(report["link"].as_str().unwrap());
        assert!(page.status == 200 && page.body.contains(&format!("<title>lid {}", k + 1)), "{report}");
    }
    // A task that cannot be read is reported at its place.
    let refused = solve(&format!("{units}points = [[0, 0]]\nclose = true\n"));
    assert_eq!(refused["state"], "failed", "{refused}");
    assert!(refused["message"].as_str().unwrap().contains("close"), "{refused}");
}
