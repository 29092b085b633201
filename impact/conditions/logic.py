"""Three-valued logic after Kleene: what is unknown (None) stays so unless the rest decides."""


def combine_and(left: bool | None, right: bool | None) -> bool | None:
    if left is False or right is False:
        return False
    return None if left is None or right is None else True


def combine_or(left: bool | None, right: bool | None) -> bool | None:
    if left is True or right is True:
        return True
    return None if left is None or right is None else False


def negate(value: bool | None) -> bool | None:
    return None if value is None else not value
