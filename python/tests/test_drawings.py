"""DXF drawings, parsed by an independent reader."""

import ezdxf
import pytest

from conftest import MODELS


@pytest.mark.parametrize("model", ["macpherson", "front_axle", "gear_train", "excavator"])
def test_a_drawing_is_read_without_a_repair(command, tmp_path, model):
    path = tmp_path / "skeleton.dxf"
    done = command("export", MODELS / f"{model}.toml", "-o", path)
    assert done.returncode == 0, done.stderr
    drawing = ezdxf.readfile(path)
    audit = drawing.audit()
    assert not audit.errors and not audit.fixes
    assert drawing.units == ezdxf.units.MM
    kinds = {entity.dxftype() for entity in drawing.modelspace()}
    assert kinds == {"POINT", "TEXT", "LINE"}
