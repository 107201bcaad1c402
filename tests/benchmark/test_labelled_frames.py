"""Labelled pictures of one's own: counted, and used to make confidences true."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mintpilot.benchmark.labelled_frames import count_frames, labelled_frames
from mintpilot.cli.main import main
from mintpilot.core.errors import InputError
from mintpilot.core.observation import Frame
from perception.scenes import Block, picture

TABLE = Block(lo_m=(1.6, -0.8, 0.70), hi_m=(2.8, 0.8, 0.74), colour=(0.55, 0.5, 0.45))
CARTONS = [
    Block(lo_m=(2.0, -0.3, 0.74), hi_m=(2.2, -0.05, 0.9), colour=(0.2, 0.2, 0.6)),
    Block(lo_m=(2.1, 0.3, 0.74), hi_m=(2.3, 0.5, 1.0), colour=(0.7, 0.1, 0.1)),
]


def save(folder: Path, name: str, seed: int) -> Frame:
    given = {"eye": (0.0, 0.0, 1.5), "pitch_rad": 0.35, "seed": seed}
    frame, without = picture([TABLE, *CARTONS], **given), picture([TABLE], **given)  # type: ignore[arg-type]
    label = np.zeros(frame.depth_m.shape, np.uint8)
    for number, carton in enumerate(CARTONS):
        alone = picture([TABLE, carton], **given)  # type: ignore[arg-type]
        label[without.depth_m - alone.depth_m > 0.05] = 10 * (number + 1)
    Image.fromarray(frame.rgb).save(folder / f"{name}_color.png")
    Image.fromarray(np.round(1000 * frame.depth_m).astype(np.uint16)).save(folder / f"{name}_depth.png")
    Image.fromarray(label).save(folder / f"{name}_label.png")
    return frame


def test_things_on_a_table_are_counted(tmp_path: Path) -> None:
    save(tmp_path, "one", 1)
    counts = count_frames(labelled_frames(tmp_path))
    assert (counts.frames, counts.things, counts.found) == (1, 2, 2)
    assert counts.split == counts.merged == 0
    assert counts.mean_iou > 0.7


@pytest.mark.long
def test_the_command_counts_a_folder_and_makes_confidences_true_by_its_names(tmp_path: Path, capsys) -> None:  # type: ignore[no-untyped-def]
    for number in range(10):
        save(tmp_path, f"view{number}", number)
    rows = "".join(f"view{n}\t1\tbox, carton\nview{n}\t2\tsculpture\n" for n in range(10))
    (tmp_path / "names.tsv").write_text("# picture, thing, names\n" + rows)
    assert main(["bench", "perception", "--data", str(tmp_path), "--json"]) == 0
    found = {row["name"]: row for row in json.loads(capsys.readouterr().out)["rows"]}
    assert found["things found (overlap over 0.5)"]["value"] == 1.0
    made = tmp_path / "mine.json"
    assert main(["bench", "perception", "--data", str(tmp_path), "--calibrate", str(made)]) == 0
    written = json.loads(made.read_text())
    assert written["only_lowers"] is False
    scale = written["namers"]["geometry"]["box"]
    assert scale["examples"] >= 15
    from mintpilot.core.observation import NameGuess
    from mintpilot.perception.calibration import CalibratedNamer, LabelScale

    class Sure:
        def names(self, frame, segments):  # type: ignore[no-untyped-def]
            return ((NameGuess(label="box", probability=0.8),),)

    ((guess,),) = CalibratedNamer(Sure(), {"box": LabelScale(**scale)}).names(None, [None])  # type: ignore[arg-type,list-item]
    assert 0.35 < guess.probability < 0.7, "half of what it calls a box is one"


def test_a_folder_that_cannot_be_used_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"_label\.png"):
        list(labelled_frames(tmp_path))
    save(tmp_path, "one", 1)
    (tmp_path / "names.tsv").write_text("one one box\n")
    with pytest.raises(InputError, match=r"names\.tsv:1"):
        list(labelled_frames(tmp_path))
