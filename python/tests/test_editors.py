"""`hardpoint lsp` with the client of pytest-lsp, which checks every answer against the specification."""

import asyncio
import json
import os
import subprocess

import pytest
from conftest import ROOT

pytest_lsp = pytest.importorskip("pytest_lsp", reason="the client needs Python 3.10")
from lsprotocol import types  # noqa: E402
from pygls.exceptions import JsonRpcException  # noqa: E402

URI = "untitled:pendel.toml"
TEXT = """name = "Pendel"
units = { length = "mm", angle = "deg" }

[hardpoints]
"Öse 🚗" = [0, 0, 500]
bob = [0, 0, 200]

[bodies]
arm = {}

[joints.hinge]
type = "revolute"
bodies = ["ground", "arm"]
at = "Öse 🚗"
axis = "y"

[drivers]
swing = { joint = "hinge", law = "90*t" }

[points]
tip = { body = "arm", at = "bob" }

[measures]
height = { type = "position", point = "tip", along = "z" }

[time]
end = 1.0
steps = 10
"""


@pytest.fixture(scope="module")
def program():
    program = os.environ.get("HARDPOINT") or ROOT / "target/release/hardpoint"
    if not os.path.exists(program):
        pytest.skip(f"there is no program {program}: `cargo build --release`, or name it in HARDPOINT")
    return str(program)


@pytest.fixture
def edit(program):
    """Runs a coroutine with a client that has opened a text."""

    def run(work, text=TEXT, uri=URI):
        async def main():
            client = pytest_lsp.make_test_lsp_client()
            await client.start_io(program, "lsp")
            try:
                capabilities = pytest_lsp.client_capabilities("visual-studio-code")
                await client.initialize_session(types.InitializeParams(capabilities=capabilities))
                if text is not None:
                    opened(client, uri, text)
                result = await work(client)
                await client.shutdown_session()
                return result
            finally:
                await client.stop()

        return asyncio.run(main())

    return run


def opened(client, uri, text):
    item = types.TextDocumentItem(uri=uri, language_id="toml", version=1, text=text)
    client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))


async def diagnostics(client, uri=URI):
    """Diagnostics of a text, once they are published."""
    for _ in range(500):
        known = client.diagnostics.get(uri)
        if known is not None:
            return list(known)
        await asyncio.sleep(0.02)
    raise AssertionError(f"no diagnostics of {uri}")


def position(text, needle, inside=0):
    """Position of a text in UTF-16 code units."""
    at = text.index(needle) + inside
    line = text.count("\n", 0, at)
    before = text[text.rfind("\n", 0, at) + 1 : at]
    return types.Position(line=line, character=len(before.encode("utf-16-le")) // 2)


def at(text, needle, inside=0, uri=URI):
    return {"text_document": types.TextDocumentIdentifier(uri=uri), "position": position(text, needle, inside)}


def cut(text, range_):
    """Text of a range in UTF-16 code units."""
    line = text.splitlines()[range_.start.line].encode("utf-16-le")
    return line[2 * range_.start.character : 2 * range_.end.character].decode("utf-16-le")


def applied(text, edits):
    lines = text.splitlines(keepends=True)
    for one in sorted(edits, key=lambda e: (e.range.start.line, e.range.start.character), reverse=True):
        line = lines[one.range.start.line].encode("utf-16-le")
        new = one.new_text.encode("utf-16-le")
        line = line[: 2 * one.range.start.character] + new + line[2 * one.range.end.character :]
        lines[one.range.start.line] = line.decode("utf-16-le")
    return "".join(lines)


def test_a_valid_text_has_no_diagnostics(edit):
    assert edit(diagnostics) == []


def test_diagnostics_have_places_codes_and_fixes(edit):
    text = TEXT.replace('point = "tip"', 'point = "tpi"').replace("[bodies]", '[bodies]\n"Ärm🚗" = {}\n', 1)

    async def work(client):
        found = await diagnostics(client)
        asked = types.CodeActionParams(
            text_document=types.TextDocumentIdentifier(uri=URI),
            range=found[0].range,
            context=types.CodeActionContext(diagnostics=list(found)),
        )
        return found, await client.text_document_code_action_async(asked)

    found, actions = edit(work, text)
    codes = {d.code: d for d in found}
    assert codes["HP0204"].severity == types.DiagnosticSeverity.Error
    assert cut(text, codes["HP0204"].range) == '"tpi"' and "did you mean `tip`?" in codes["HP0204"].message
    assert cut(text, codes["HP0212"].range) == '"Ärm🚗"'
    (action,) = actions
    assert action.title == "Replace by `tip`" and action.kind == types.CodeActionKind.QuickFix
    assert 'point = "tip"' in applied(text, action.edit.changes[URI])


def test_incremental_changes_are_in_utf_16(edit):
    async def work(client):
        await diagnostics(client)
        changes = [
            # Of the middle of a line after a car, then a whole text, then an insertion.
            types.TextDocumentContentChangePartial(
                range=types.Range(start=position(TEXT, " = [0, 0, 500]"), end=position(TEXT, "[0, 0, 500]")),
                text=" =\t",
            ),
            types.TextDocumentContentChangePartial(
                range=types.Range(start=position(TEXT, "arm = {}"), end=position(TEXT, "arm = {}", 3)), text="mra"
            ),
        ]
        client.diagnostics.pop(URI)
        client.text_document_did_change(
            types.DidChangeTextDocumentParams(
                text_document=types.VersionedTextDocumentIdentifier(uri=URI, version=2), content_changes=changes
            )
        )
        wrong = await diagnostics(client)
        client.diagnostics.pop(URI)
        client.text_document_did_change(
            types.DidChangeTextDocumentParams(
                text_document=types.VersionedTextDocumentIdentifier(uri=URI, version=3),
                content_changes=[types.TextDocumentContentChangeWholeDocument(text=TEXT)],
            )
        )
        return wrong, await diagnostics(client)

    wrong, right = edit(work)
    assert any(d.code == "HP0204" and "`arm`" in d.message for d in wrong)
    assert not any(d.code == "HP0102" for d in wrong)
    assert right == []


def test_completion_offers_keys_names_and_words(edit):
    async def labels(client, text, needle):
        opened(client, "untitled:x.toml", text)
        asked = types.CompletionParams(**at(text, needle, len(needle), "untitled:x.toml"))
        found = await client.text_document_completion_async(asked)
        return {item.label: item for item in found.items}

    async def work(client):
        bodies = await labels(client, TEXT.replace('["ground", "arm"]', '["ground", "'), '["ground", "')
        hardpoints = await labels(client, TEXT.replace('at = "Öse 🚗"', "at = "), "\nat = ")
        types_ = await labels(client, TEXT.replace('"revolute"', '"rev'), '"rev')
        keys = await labels(client, TEXT.replace('at = "Öse 🚗"', "ax"), "\nax")
        return bodies, hardpoints, types_, keys

    bodies, hardpoints, types_, keys = edit(work, None)
    assert list(bodies) == ["ground", "arm"] and bodies["arm"].detail == "body"
    assert list(hardpoints) == ["Öse 🚗", "bob"] and hardpoints["bob"].text_edit.new_text == '"bob"'
    assert "Coordinate: `angle`" in types_["revolute"].documentation.value
    assert keys["axis2"].text_edit.new_text == "axis2 = " and "type" not in keys


def test_hover_shows_values_with_units_and_meanings(edit):
    async def work(client):
        await diagnostics(client)
        hover = client.text_document_hover_async
        return [
            (await hover(types.HoverParams(**at(TEXT, needle, 2)))).contents.value
            for needle in ['"bob"', "height = ", '"hinge"', "bodies = [", '"revolute"']
        ] + [await hover(types.HoverParams(**at(TEXT, "[0, 0, 500]", 4)))]

    bob, height, hinge, key, word, nothing = edit(work)
    assert "(0, 0, 200) mm" in bob
    assert "in mm" in height and "tip" in height
    assert "revolute between `ground` and `arm`" in hinge and "`angle`" in hinge
    assert "(required)" in key and "Example" in key
    assert "revolute" in word
    assert nothing is None


def test_definition_references_and_highlights(edit):
    async def work(client):
        definition = await client.text_document_definition_async(types.DefinitionParams(**at(TEXT, '"Öse 🚗"\naxis', 2)))
        context = types.ReferenceContext(include_declaration=True)
        references = await client.text_document_references_async(
            types.ReferenceParams(context=context, **at(TEXT, "arm = {}"))
        )
        highlights = await client.text_document_document_highlight_async(
            types.DocumentHighlightParams(**at(TEXT, "arm = {}"))
        )
        return definition, references, highlights

    definition, references, highlights = edit(work)
    (place,) = definition
    assert place.uri == URI and cut(TEXT, place.range) == "Öse 🚗" and place.range.start.line == 4
    assert [cut(TEXT, r.range) for r in references] == ["arm"] * 3
    assert len(highlights) == 3


def test_rename_edits_all_places_or_none(edit):
    async def work(client):
        rename = client.text_document_rename_async
        prepared = await client.text_document_prepare_rename_async(
            types.PrepareRenameParams(**at(TEXT, '"Öse 🚗" =', 2))
        )
        done = await rename(types.RenameParams(new_name="Lager", **at(TEXT, '"Öse 🚗" =', 2)))
        refusals = []
        for needle, new in [("bob = [", "Öse 🚗"), ('"ground"', "earth"), ("steps", "count")]:
            with pytest.raises(JsonRpcException) as caught:
                await rename(types.RenameParams(new_name=new, **at(TEXT, needle, 2)))
            refusals.append(caught.value.message)
        return prepared, done, refusals

    prepared, done, refusals = edit(work)
    assert prepared.placeholder == "Öse 🚗" and cut(TEXT, prepared.range) == "Öse 🚗"
    new = applied(TEXT, done.changes[URI])
    assert new.count("Lager") == 2 and "Öse" not in new
    assert edit(diagnostics, new) == []
    assert "already" in refusals[0] and "fixed body" in refusals[1] and "no name" in refusals[2]


def test_symbols_are_sections_with_entries(edit):
    async def work(client):
        asked = types.DocumentSymbolParams(text_document=types.TextDocumentIdentifier(uri=URI))
        return await client.text_document_document_symbol_async(asked)

    symbols = {symbol.name: symbol for symbol in edit(work)}
    assert list(symbols)[:4] == ["name", "units", "hardpoints", "bodies"]
    assert [child.name for child in symbols["hardpoints"].children] == ["Öse 🚗", "bob"]
    assert symbols["joints"].children[0].detail == "revolute"


def test_included_files_are_parts_of_the_model(edit, tmp_path):
    """Errors of a part are reported in the part, and entries are found there."""
    model, part = tmp_path / "whole.toml", tmp_path / "part.toml"
    part.write_text('units = { length = "mm", angle = "deg" }\nhardpoints = { far = [1, 2, 3] }\n')
    text = 'include = ["part.toml"]\n' + TEXT.replace('at = "bob"', 'at = "far"')
    model.write_text(text)

    async def work(client):
        first = await diagnostics(client, model.as_uri())
        definition = await client.text_document_definition_async(
            types.DefinitionParams(**at(text, '"far"', 2, model.as_uri()))
        )
        part.write_text(part.read_text().replace("far = [1, 2, 3]", "far = [1, 2]"))
        client.diagnostics.clear()
        opened(client, part.as_uri(), part.read_text())
        return first, definition, await diagnostics(client, part.as_uri())

    first, (place,), wrong = edit(work, text, model.as_uri())
    assert first == []
    assert place.uri == part.as_uri() and place.range.start.line == 1
    assert [d.code for d in wrong] == ["HP0105"] and wrong[0].range.start.line == 1


def test_order_of_the_protocol(program):
    def message(**content):
        body = json.dumps({"jsonrpc": "2.0", **content})
        return f"Content-Length: {len(body.encode())}\r\n\r\n{body}"

    def run(*messages):
        text = "".join(messages).encode()
        done = subprocess.run([program, "lsp"], input=text, capture_output=True, timeout=60)
        return done.returncode, done.stdout.decode()

    initialize = message(id=1, method="initialize", params={"capabilities": {}})
    shutdown, exit_ = message(id=2, method="shutdown"), message(method="exit")
    code, out = run(message(id=7, method="textDocument/hover", params={}), initialize, shutdown, exit_)
    assert code == 0 and "-32002" in out and out.count("Content-Length") == 3
    # `exit` without `shutdown`, and a request after it.
    assert run(initialize, exit_)[0] == 1
    code, out = run(initialize, shutdown, message(id=3, method="textDocument/hover", params={}), exit_)
    assert code == 0 and "-32600" in out
    code, out = run(initialize, message(id=4, method="no/such"), message(id=5, method="textDocument/hover"), shutdown, exit_)
    assert "-32601" in out and "-32602" in out
    # A text that is no message ends the server with an explanation.
    code, out = run("hello\r\n\r\n")
    assert code == 2 and out == ""


def test_configurations_of_the_document_start_the_server(program):
    tomllib = pytest.importorskip("tomllib", reason="needs Python 3.11")
    text = (ROOT / "docs/editors.md").read_text()
    helix = tomllib.loads(text.split("```toml\n")[1].split("```")[0])
    server = helix["language-server"]["hardpoint"]
    assert helix["language"][0]["language-servers"] == ["hardpoint"]
    for command in [[server["command"], *server["args"]], ["hardpoint", "lsp"], ["hardpoint", "lsp", "--stdio"]]:
        assert command[0] == "hardpoint"
        done = subprocess.run([program, *command[1:]], input=b"", capture_output=True, timeout=60)
        # Without `shutdown` the end of the input is an error of the editor.
        assert done.returncode == 1 and done.stdout == b""
    assert "cmd = { 'hardpoint', 'lsp' }" in text and '("hardpoint" "lsp")' in text
