"""The texts of a drawing, and whether they can be read."""

from ezdxf.document import Drawing
from ezdxf.tools.text_size import text_size


def texts(document: Drawing) -> list[str]:
    return [entity.dxf.text for entity in document.modelspace().query("TEXT")]


def no_text_lies_on_another(kind: str, document: Drawing) -> None:
    boxes = []
    for entity in document.modelspace().query("TEXT"):
        size = text_size(entity)
        width, height = size.width, size.cap_height
        place = entity.get_placement()
        x, y = place[1].x, place[1].y
        if "CENTER" in place[0].name:
            x -= 0.5 * width
        if "TOP" in place[0].name:
            y -= height
        if "MIDDLE" in place[0].name:
            y -= 0.5 * height
        boxes.append((x, x + width, y, y + height, entity.dxf.text))
    for index, (left, right, low, high, text) in enumerate(boxes):
        for other_left, other_right, other_low, other_high, other in boxes[:index]:
            apart = left >= other_right or right <= other_left or low >= other_high or high <= other_low
            assert apart, f"{kind}: {text!r} lies on {other!r}"
