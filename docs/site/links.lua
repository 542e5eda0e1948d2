-- Links between pages become links between HTML files; [@key] links to its row of the references; the first heading is the title.
local page = ""

local function target(url)
  local name = url:match("cases/([%w-]+)/README%.md$")
  if name then return "cases/" .. name .. ".html" end
  if url:match("cases/README%.md$") then return "gallery.html" end
  if url:match("library/README%.md$") then return "library.html" end
  url = url:gsub("^%.%./([A-Z]+%.md)", "%1"):gsub("^docs/", "")
  if page:match("^cases/") or url:match("^%a+:") then return url end
  return (url:gsub("^README%.md", "index.md"):gsub("%.md(#?)", ".html%1"))
end

function Meta(meta)
  page = pandoc.utils.stringify(meta.page or "")
end

function Link(link)
  if page:match("^cases/") and link.target:match("%.toml$") then return link.content end  -- the site has no files of cases
  link.target = target(link.target)
  return link
end

function Image(image)
  local name, file = image.src:match("cases/([%w-]+)/([%w-]+%.png)$")
  if page:match("^cases/") then
    local other, drawn = image.src:match("^%.%./([%w-]+)/([%w-]+%.png)$")
    if other then
      image.src = other .. "-" .. drawn
      return image
    end
  end
  if name then image.src = "cases/" .. name .. "-" .. file end
  if page:match("^cases/") and not name then image.src = page:match("^cases/([%w-]+)/") .. "-" .. image.src end
  return image
end

-- `[@key]` in the text, and the row of a table that defines it.
function Str(str)
  local before, key, after = str.text:match("^(.-)%[@([%w-]+)%](.*)$")
  if not key then return nil end
  local root = page:match("^cases/") and "../" or ""
  return { pandoc.Str(before), pandoc.Link("[" .. key .. "]", root .. "references.html#" .. key), pandoc.Str(after) }
end

function Code(code)
  local key = code.text:match("^%[@([%w-]+)%]$")
  if key then return pandoc.Span({ pandoc.Code(key) }, { id = key }) end
end

function Pandoc(doc)
  local first = doc.blocks[1]
  if first and first.t == "Header" and first.level == 1 then doc.meta.title = pandoc.MetaInlines(first.content) end
  return doc
end

return { { Meta = Meta }, { Link = Link, Image = Image, Str = Str, Code = Code }, { Pandoc = Pandoc } }
