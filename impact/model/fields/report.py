"""The report on fields: by topic and subscriber which are read, by publisher which are set."""

from __future__ import annotations

import msgspec


class FieldAt(msgspec.Struct, frozen=True):
    """A field, and the first place that reads or sets it."""

    field: str
    path: str
    line: int


class EscapedField(msgspec.Struct, frozen=True):
    """A field whose whole contents count as read, and why. field: empty for the whole message."""

    field: str
    reason: str
    path: str
    line: int


class SubscriberFields(msgspec.Struct, frozen=True):
    """A subscriber. node: as in the graph; path, line: where it subscribes. callback: the functions that are called.
    reads: what is read; sizes: arrays of messages whose length is asked for; unread: the fields that are neither read
    nor part of what escapes, nor of elements that are counted only."""

    node: str
    path: str
    line: int
    callback: str
    reads: tuple[FieldAt, ...]
    unread: tuple[str, ...]
    escapes: tuple[EscapedField, ...]
    sizes: tuple[FieldAt, ...] = ()


class PublisherFields(msgspec.Struct, frozen=True):
    """A publish statement. sets: fields that are set, each where it is first; unknown: why others may be set too, empty
    where they are not. lengths: of texts in bytes and of arrays in elements, by field, where the code writes them;
    `names[]` is of the texts in an array."""

    node: str
    path: str
    line: int
    sets: tuple[FieldAt, ...]
    unknown: str = ""
    lengths: tuple[tuple[str, int], ...] = ()


class TopicFields(msgspec.Struct, frozen=True):
    """A topic. fields: all leaves of its type. unread: those that no subscriber reads, empty where all must be kept;
    open: why somebody who is not seen may read it."""

    topic: str
    type: str
    fields: tuple[str, ...]
    subscribers: tuple[SubscriberFields, ...]
    publishers: tuple[PublisherFields, ...]
    unread: tuple[str, ...]
    open: tuple[str, ...] = ()


class FieldReport(msgspec.Struct, frozen=True):
    """All topics. unknown: topics whose type's fields are not known, with the type. unnamed: subscribers whose topic is
    not known, under an empty name, by type."""

    topics: tuple[TopicFields, ...] = ()
    unknown: tuple[tuple[str, str], ...] = ()
    unnamed: tuple[TopicFields, ...] = ()
