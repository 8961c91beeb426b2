"""`hardpoint mcp` with the official client: both eras of the protocol, all tools, errors, progress, cancellation.

The client validates every structured result against the schema that the tool declares.
"""

import asyncio
import json
import os
import subprocess
import time

import pytest
from conftest import MODELS, ROOT

mcp = pytest.importorskip("mcp", reason="the client needs Python 3.10")

PENDULUM = """
name = "pendulum"
units = { length = "mm", angle = "deg" }
hardpoints = { pivot = [0, 0, 500], bob = [0, 0, 200] }
bodies = { arm = {} }
joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
drivers.swing = { joint = "hinge", law = "90*t" }
points.bob = { body = "arm", at = "bob" }
measures.height = { type = "position", point = "bob", along = "z" }
design.bob = { move = "bob", along = "z" }
time = { end = 1.0, steps = 90 }
"""


@pytest.fixture(scope="module", params=["legacy", "auto"])
def serve(request, program):
    """Runs a coroutine with a connected client."""

    def run(work):
        async def main():
            server = mcp.StdioServerParameters(command=str(program), args=["mcp"], cwd=str(ROOT))
            async with mcp.Client(server, mode=request.param) as client:
                return await work(client)

        return asyncio.run(main())

    run.mode = request.param
    return run


@pytest.fixture(scope="module")
def program():
    program = os.environ.get("HARDPOINT") or ROOT / "target/release/hardpoint"
    if not os.path.exists(program):
        pytest.skip(f"there is no program {program}: `cargo build --release`, or name it in HARDPOINT")
    return program


def called(serve, tool, **arguments):
    """Structured result of a tool."""

    async def work(client):
        return await client.call_tool(tool, arguments)

    result = serve(work)
    assert not result.is_error, result.content[0].text
    # The text is the same result, for clients without structure.
    assert json.loads(result.content[0].text) == result.structured_content
    return result.structured_content


def failed(serve, tool, **arguments):
    """Text of a result that is an error."""

    async def work(client):
        return await client.call_tool(tool, arguments)

    result = serve(work)
    assert result.is_error
    return result.content[0].text


def test_versions_are_negotiated(serve):
    async def work(client):
        tools = (await client.list_tools()).tools
        return client.protocol_version, client.server_info.name, {tool.name for tool in tools}

    version, name, tools = serve(work)
    assert version == {"legacy": "2025-11-25", "auto": "2026-07-28"}[serve.mode]
    assert name == "hardpoint"
    assert {"check", "run", "what_if", "optimize", "tolerance", "sweep", "synthesize", "explain"} <= tools


def test_resources_are_documents_schema_and_templates(serve):
    async def work(client):
        resources = (await client.list_resources()).resources
        texts = {}
        for resource in resources:
            (content,) = (await client.read_resource(resource.uri)).contents
            assert content.mime_type == resource.mime_type
            texts[str(resource.uri)] = content.text
        return texts

    texts = serve(work)
    assert texts["hardpoint://docs/file-format.md"] == (ROOT / "docs/file-format.md").read_text()
    assert json.loads(texts["hardpoint://schema/model.json"])["title"] == "Hardpoint model"
    assert "[hardpoints]" in texts["hardpoint://templates/macpherson.toml"]


def test_check_reports_facts(serve):
    (case,) = called(serve, "check", path="models/macpherson.toml")["cases"]
    assert case["status"] == "complete"
    assert case["counts"]["mobility"] == 2
    assert {"name": "tie_rod", "type": "distance"}.items() <= case["joints"][4].items()
    assert all(variable["unit"] for variable in case["variables"])


def test_a_model_with_errors_is_a_result_with_places_and_fixes(serve):
    text = failed(serve, "check", text=PENDULUM.replace('"arm"], at', '"amr"], at'))
    assert "error[HP0204]" in text and "model.toml:6" in text and "did you mean `arm`?" in text
    text = failed(serve, "run", path="models/nowhere.toml")
    assert "HP0101" in text and "`bennett.toml`" in text


def test_run_of_a_text_is_the_pendulum_of_the_formula(serve):
    (case,) = called(serve, "run", text=PENDULUM)["cases"]
    (height,) = [m for m in case["measures"] if m["measure"] == "height"]
    # z = 500 - 300 cos(90 deg t)
    assert height == {
        "measure": "height", "unit": "mm", "start": 200.0, "end": 500.0,
        "min": 200.0, "min_time": 0.0, "max": 500.0, "max_time": 1.0,
    }
    (ranking,) = [r for r in case["sensitivities"] if r["measure"] == "height"]
    # dz/db = cos(90 deg t): 1 at the start
    assert ranking["largest"][0] == {"variable": "bob", "per": "mm", "value": 1.0, "unit": "mm/mm", "time": 0.0}


def test_what_if_agrees_with_the_command(serve, command):
    (case,) = called(
        serve, "what_if", path="models/macpherson.toml", changes={"tie_rod_outer.z": "+2 mm"}, measures=["toe"]
    )["cases"]
    done = command("whatif", MODELS / "macpherson.toml", "--set", "tie_rod_outer.z=+2mm", "--json")
    answer = json.loads(done.stdout)
    (toe,) = case["measures"]
    (exact,) = [m for m in answer["measures"] if m["measure"] == "toe"]
    assert toe["unit"] == "deg"
    assert toe["change"] == pytest.approx(exact["change"], rel=1e-5)
    # Curves are ranges: an agent does not read 501 numbers.
    assert toe["exact"]["count"] == 501 and toe["exact"]["max"] == pytest.approx(max(exact["exact"]), rel=1e-5)
    # A number is in the unit of the model.
    (same,) = called(serve, "what_if", path="models/macpherson.toml", changes={"tie_rod_outer.z": 2})["cases"]
    assert same["measures"][0] == toe
    assert "tie_rod_outer" in failed(serve, "what_if", path="models/macpherson.toml", changes={"tie_rod_outr.z": 2})


@pytest.mark.parametrize("tool", ["run", "what_if"])
def test_an_unknown_measure_is_an_error(serve, tool):
    text = failed(serve, tool, text=PENDULUM, measures=["height", "hight"])
    assert "HP0602" in text and "`hight`" in text and "did you mean `height`?" in text


def test_optimize_saves_the_optimised_model(serve, tmp_path):
    # The targets are in a file next to the model.
    for name in ["four_bar_inverse.toml", "four_bar_inverse.csv"]:
        (tmp_path / name).write_text((MODELS / name).read_text())
    saved = tmp_path / "found.toml"
    result = called(serve, "optimize", path=str(tmp_path / "four_bar_inverse.toml"), save=str(saved))
    assert result["status"] == "optimal"
    # They are the curves of this four-bar, in mm and deg.
    assert max(abs(goal["after"]) for goal in result["goals"]) < 1e-6
    (case,) = called(serve, "check", path=str(saved))["cases"]
    assert case["status"] == "complete"


def test_optimize_of_a_template(serve):
    model = called(serve, "new_model", template="five-link", name="rear")
    assert model["text"].splitlines()[0].startswith("#")
    result = called(serve, "optimize", text=model["text"], iterations=2)
    assert "/" not in result["file"] and result["file"] == "model.toml"
    assert ("optimised_text" in result) != ("not_saved" in result)


def test_studies(serve):
    result = called(serve, "tolerance", path="models/studies/strut_tolerances.toml", samples=200, seed=3)
    assert result["status"] == "complete" and result["samples"] == 200 and result["metrics"][0]["unit"]
    result = called(serve, "sweep", path="models/studies/strut_sweep.toml", samples=20, method="latin_hypercube")
    assert result["designs"] == 20 and result["method"] == "latin_hypercube"
    result = called(serve, "synthesize", path="models/tasks/gripper.toml", answers=2)
    assert [answer["rank"] for answer in result["answers"]] == [1, 2]


def test_templates_diagnostics_and_imports(serve, tmp_path):
    names = [template["name"] for template in called(serve, "new_model")["templates"]]
    assert "macpherson" in names
    to = tmp_path / "new.toml"
    assert called(serve, "new_model", template="delta", save=str(to))["saved"] == str(to)
    assert "exists already" in failed(serve, "new_model", template="delta", save=str(to))
    answer = called(serve, "explain", code="hp0204")
    assert answer["code"] == "HP0204" and answer["remedy"]
    assert "no diagnostic" in failed(serve, "explain", code="HP9999")
    source = sorted((ROOT / "crates").rglob("*.asmt"))[0]
    result = called(serve, "import_model", source=str(source), output=str(tmp_path / "imported.toml"))
    assert result["status"] == "complete" and (tmp_path / "imported.toml").exists()


def test_wrong_arguments_are_errors_of_the_protocol(serve):
    async def work(client):
        messages = []
        for tool, arguments in [
            ("check", {}),
            ("check", {"path": "a.toml", "text": "b"}),
            ("check", {"file": "a.toml"}),
            ("run", {"path": "models/macpherson.toml", "variables": "many"}),
            ("nothing", {}),
        ]:
            with pytest.raises(mcp.MCPError) as caught:
                await client.session.call_tool(tool, arguments)
            assert caught.value.error.code == -32602
            messages.append(caught.value.error.message)
        return messages

    messages = serve(work)
    assert "`path` or as `text`" in messages[0] and "not both" in messages[1]
    assert "no argument `file`" in messages[2] and "`path`" in messages[2]
    assert "the tools are check" in messages[4]


def test_progress_is_reported_and_increases(serve):
    async def work(client):
        seen = []

        async def heard(progress, total, message):
            seen.append((progress, total, message))

        arguments = {"path": "models/studies/strut_tolerances.toml", "samples": 3000}
        await client.call_tool("tolerance", arguments, progress_callback=heard)
        return seen

    seen = serve(work)
    assert len(seen) > 2
    assert all(a[0] < b[0] for a, b in zip(seen, seen[1:]))
    assert any("3000 designs" in message for *_, message in seen)


def test_a_cancelled_study_ends_and_the_server_goes_on(serve):
    async def work(client):
        arguments = {"path": "models/studies/strut_tolerances.toml", "samples": 1_000_000}
        started = time.monotonic()
        with pytest.raises(asyncio.TimeoutError):
            await asyncio.wait_for(client.call_tool("tolerance", arguments), 1.0)
        result = await client.call_tool("check", {"text": PENDULUM})
        assert not result.is_error
        return time.monotonic() - started

    # A million designs take minutes.
    assert serve(work) < 30.0


def raw(program, *messages):
    """Answers to raw lines, by id, and stderr."""
    text = "".join(m if isinstance(m, str) else json.dumps(m) + "\n" for m in messages)
    done = subprocess.run([program, "mcp"], input=text, capture_output=True, text=True, cwd=ROOT, timeout=60)
    assert done.returncode == 0
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_invalid_messages_are_answered(program):
    answers = raw(
        program,
        "nonsense\n",
        {"jsonrpc": "2.0", "id": 1, "method": "tools/list"},
        {"jsonrpc": "2.0", "id": 2, "method": "ping"},
        {"jsonrpc": "2.0", "id": 3, "method": "initialize", "params": {"protocolVersion": "1999-01-01"}},
        {"jsonrpc": "2.0", "id": 4, "method": "initialize", "params": {"protocolVersion": "2025-06-18"}},
        {"jsonrpc": "2.0", "id": 5, "method": "no/such"},
        {"jsonrpc": "2.0", "id": 6, "method": "resources/read", "params": {"uri": "hardpoint://docs/no.md"}},
        {"jsonrpc": "2.0", "method": "notifications/unknown"},
    )
    codes = [answer.get("error", {}).get("code") for answer in answers]
    assert codes == [-32700, -32002, None, None, -32600, -32601, -32002]
    assert [answer["id"] for answer in answers] == [None, 1, 2, 3, 4, 5, 6]
    # An unknown version is answered by the newest one of the handshake.
    assert answers[3]["result"]["protocolVersion"] == "2025-11-25"


def test_requests_with_an_unknown_version_name_the_supported_ones(program):
    meta = {"io.modelcontextprotocol/protocolVersion": "2031-01-01", "io.modelcontextprotocol/clientCapabilities": {}}
    (answer,) = raw(program, {"jsonrpc": "2.0", "id": 1, "method": "tools/list", "params": {"_meta": meta}})
    assert answer["error"]["code"] == -32022
    assert answer["error"]["data"] == {"supported": ["2026-07-28"], "requested": "2031-01-01"}


def test_examples_of_the_document_work(program, serve):
    text = (ROOT / "docs/agents.md").read_text()
    blocks = [block.split("```")[0] for block in text.split("```json\n")[1:]]
    servers, editor, arguments = map(json.loads, blocks)
    for entry in [servers["mcpServers"]["hardpoint"], editor["servers"]["hardpoint"]]:
        assert (entry["command"], entry["args"]) == ("hardpoint", ["mcp"])
    (case,) = called(serve, "what_if", **arguments)["cases"]
    assert [measure["measure"] for measure in case["measures"]] == arguments["measures"]
    shell = text.split("$ echo '")[1]
    asked, answer = shell.split("'")[0], shell.splitlines()[1]
    assert raw(program, asked + "\n") == [json.loads(answer)]


def test_the_document_lists_all_tools(serve):
    async def work(client):
        return (await client.list_tools()).tools

    text = (ROOT / "docs/agents.md").read_text()
    for tool in serve(work):
        row = next(line for line in text.splitlines() if line.startswith(f"| `{tool.name}` |"))
        named = row.split("|")[2]
        for key in tool.input_schema["properties"]:
            assert key in ("path", "text", "case") or f"`{key}`" in named, (tool.name, key)
